"""Reading HDF5 files that nobody vouches for.

HDF5 can point outside itself (external links, external storage, virtual datasets), hold
references to any object, run filter plug-ins, and unpack kilobytes into terabytes. All of that
is refused before any data is read.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

MAX_BYTES = 4 * 2**30
"""Unpacked bytes that all datasets of a file may hold together."""

MAX_OBJECTS = 100_000

_PLAIN_FILTERS = {h5py.h5z.FILTER_DEFLATE, h5py.h5z.FILTER_SHUFFLE, h5py.h5z.FILTER_FLETCHER32}
_MISSING: Any = object()


@contextmanager
def opened(path: Path) -> Iterator[h5py.File]:
    """Open an HDF5 file for reading once everything in it has been found harmless.

    Raises:
        ValueError: it is missing, damaged, or holds something refused.
    """
    if not path.is_file():
        raise ValueError(f"There is no file {path}.")
    try:
        file = h5py.File(path, "r")
    except OSError as error:
        reason = (
            "it is cut short or damaged; copy it again"
            if h5py.is_hdf5(path)
            else "its signature is missing"
        )
        raise ValueError(f"{path} is not a whole HDF5 file: {reason}.") from error
    with file:
        try:
            _check_harmless(file)
            yield file
        except (OSError, KeyError, RuntimeError, TypeError) as error:
            raise ValueError(f"{path} is damaged: {error}. Copy it again.") from error


def read_group(parent: h5py.Group, name: str) -> h5py.Group:
    """Return a group.

    Raises:
        ValueError: it is missing or something else.
    """
    item = parent.get(name)
    if not isinstance(item, h5py.Group):
        raise ValueError(f"the group {parent.name.rstrip('/')}/{name} is missing.")
    return item


def read_array(
    group: h5py.Group, name: str, unit: str, *, complex_values: bool = False
) -> NDArray[Any]:
    """Return a dataset of real (or complex) numbers in the unit it must be in.

    Raises:
        ValueError: it is missing, holds something else than such numbers, or in another unit.
    """
    item = group.get(name)
    wanted = "complex numbers" if complex_values else "real numbers"
    if not isinstance(item, h5py.Dataset):
        raise ValueError(f"the dataset {group.name.rstrip('/')}/{name} with {wanted} is missing.")
    if item.dtype.kind not in ("c" if complex_values else "fiu"):
        raise ValueError(f"the dataset {item.name} must hold {wanted}, it holds {item.dtype}.")
    stated = item.attrs.get("unit")
    if stated != unit:
        raise ValueError(f'the dataset {item.name} must be in "{unit}", its unit is "{stated}".')
    return np.asarray(item[()])


def read_attribute(group: h5py.Group, name: str, kind: type, default: Any = _MISSING) -> Any:
    """Return an attribute as `kind`, or `default` where one is given and it is not there.

    Raises:
        ValueError: it is missing or cannot be read as `kind`.
    """
    value = group.attrs.get(name)
    if value is None:
        if default is _MISSING:
            raise ValueError(f'the attribute "{name}" of {group.name} is missing.')
        return default
    try:
        return kind(value)
    except (TypeError, ValueError) as error:
        raise ValueError(
            f'the attribute "{name}" of {group.name} is {value!r}, which is no {kind.__name__}.'
        ) from error


def _check_harmless(file: h5py.File) -> None:
    total, objects = 0, 0
    for path, group in _groups(file):
        for name in group:
            objects += 1
            if objects > MAX_OBJECTS:
                raise ValueError(f"{file.filename} holds more than {MAX_OBJECTS} objects.")
            link = group.get(name, getlink=True)
            if not isinstance(link, h5py.HardLink):
                raise ValueError(
                    f"{file.filename}: {path}{name} is a {type(link).__name__}, which may point "
                    "anywhere; only data inside the file is accepted."
                )
            item = group[name]
            if isinstance(item, h5py.Dataset):
                _check_dataset(file.filename, item)
                total += item.size * item.dtype.itemsize
    if total > MAX_BYTES:
        raise ValueError(
            f"{file.filename} would unpack to {total / 2**30:.1f} GiB; at most "
            f"{MAX_BYTES / 2**30:.0f} GiB are read."
        )


def _groups(file: h5py.File) -> Iterator[tuple[str, h5py.Group]]:
    """Yield every group once, following hard links only, with its path."""
    waiting, seen = [("/", file)], set()
    while waiting:
        path, group = waiting.pop()
        key = h5py.h5o.get_info(group.id).addr
        if key in seen:
            continue
        seen.add(key)
        yield path, group
        for name in group:
            hard = isinstance(group.get(name, getlink=True), h5py.HardLink)
            if hard and group.get(name, getclass=True) is h5py.Group:
                waiting.append((f"{path}{name}/", group[name]))


def _check_dataset(filename: str, dataset: h5py.Dataset) -> None:
    creation = dataset.id.get_create_plist()
    filters = {creation.get_filter(index)[0] for index in range(creation.get_nfilters())}
    problem = ""
    if dataset.is_virtual:
        problem = "is a virtual dataset, whose data lies in other files"
    elif dataset.external:
        problem = "keeps its data outside the file"
    elif filters - _PLAIN_FILTERS:
        problem = f"needs a foreign filter ({sorted(filters - _PLAIN_FILTERS)})"
    elif h5py.check_ref_dtype(dataset.dtype) is not None or dataset.dtype.kind not in "fiucSb":
        problem = f"holds {dataset.dtype}, not plain numbers"
    if problem:
        raise ValueError(f"{filename}: {dataset.name} {problem}; it is refused.")
