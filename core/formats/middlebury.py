"""Calibrated photographs in the form of the Middlebury multi-view stereo data sets."""

from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.frame import Frame
from core.optical.camera import camera_projection
from core.silhouettes.photograph import Photograph

PARAMETERS_PER_LINE = 21
"""K and R, nine numbers each, row by row, and the three of t."""


def read_photographs(folder: Path) -> tuple[Photograph, ...]:
    """Read the photographs that the one `*_par.txt` of a folder lists, in its order.

    Each one's amplitude is the picture's luma (ITU-R BT.601) from 0 to 1, as the file holds it,
    not linearised. The projection is perspective, the target frame is the data set's own, in
    metres. The files give no times; the photographs stand one second apart in listed order.

    Raises:
        ValueError: no or several lists of cameras, a line that is no camera, or a picture that is
            missing or cannot be read.

    Source: Seitz et al., "A comparison and evaluation of multi-view stereo reconstruction
    algorithms", CVPR 2006, whose data sets define the form.
    """
    lines = _camera_lines(_camera_list(folder))
    return tuple(_photograph(folder, number, *line) for number, line in enumerate(lines))


def _camera_list(folder: Path) -> Path:
    if not folder.is_dir():
        raise ValueError(
            f"Wanted a folder with a Middlebury *_par.txt and its pictures; {folder} is no folder."
        )
    lists = sorted(folder.glob("*_par.txt"))
    if len(lists) != 1:
        found = ", ".join(path.name for path in lists) or "none"
        raise ValueError(
            f"Wanted one list of cameras (*_par.txt) in {folder}, found {found}. "
            "Give the folder of one unpacked Middlebury data set."
        )
    return lists[0]


def _camera_lines(path: Path) -> list[tuple[str, Floats]]:
    """Return picture name and 21 camera parameters of each line after the count."""
    try:
        count, *lines = path.read_text(encoding="utf-8").split("\n")
    except UnicodeDecodeError as error:
        raise ValueError(f"{path.name} is no text file: {error}.") from error
    cameras = [
        _camera_line(line, f"{path.name}, line {number}")
        for number, line in enumerate(lines, start=2)
        if line.strip()
    ]
    if count.strip() != str(len(cameras)) or not cameras:
        raise ValueError(
            f'{path.name} announces "{count.strip()[:20]}" pictures in its first line and lists '
            f"{len(cameras)}; is the file cut off?"
        )
    return cameras


def _camera_line(line: str, where: str) -> tuple[str, Floats]:
    name, *words = line.split()
    try:
        parameters = np.array(words, dtype=np.float64)
    except ValueError as error:
        raise ValueError(f"{where}: {error}; wanted a picture's name and numbers.") from error
    if len(parameters) != PARAMETERS_PER_LINE or not np.all(np.isfinite(parameters)):
        raise ValueError(
            f"{where}: wanted a picture's name and {PARAMETERS_PER_LINE} finite numbers "
            f"(K, R, t), got {len(parameters)}."
        )
    if Path(name).name != name:
        raise ValueError(f'{where}: the picture "{name}" must lie in the same folder.')
    return name, parameters


def _photograph(folder: Path, number: int, name: str, parameters: Floats) -> Photograph:
    intrinsics, rotation = parameters[:18].reshape(2, 3, 3)
    try:
        projection = camera_projection(intrinsics, rotation, parameters[18:])
    except ValueError as error:
        raise ValueError(f"Camera of {name}: {error}") from error
    colours = _colours(folder / name)
    luma = cv2.cvtColor(colours.astype(np.float32) / np.float32(255), cv2.COLOR_RGB2GRAY)
    frame = Frame(
        amplitude=luma,
        projection=projection,
        time_s=float(number),
        sensor="optical",
        line_of_sight=projection.viewing_direction(),
        label=Path(name).stem,
    )
    return Photograph(frame=frame, colours=colours)


def _colours(path: Path) -> NDArray[np.uint8]:
    """Return a picture's red, green and blue, (rows, columns, 3)."""
    if not path.is_file():
        raise ValueError(
            f"The list of cameras names {path.name}, which is not in {path.parent}; "
            "unpack the data set whole."
        )
    picture = cv2.imdecode(np.fromfile(path, dtype=np.uint8), cv2.IMREAD_COLOR_RGB)
    if picture is None:
        raise ValueError(f"{path.name} is no picture that OpenCV can read; is it cut off?")
    return np.asarray(picture, dtype=np.uint8)
