"""The hull held against a reference mesh: on request, in a thread, stamped with the revision."""

import logging
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import trimesh
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from app.snapshot import Snapshot
from core.arrays import Floats
from core.hull.closed_mesh import Surface
from core.measurement.comparison import ReferenceComparison, compare, placed
from core.measurement.regions import area_vectors_m2

DISTANCE_COLOURS = ("#2166ac", "#67a9cf", "#f7f7f7", "#ef8a62", "#b2182b")
"""From the deepest inside to the farthest outside.

Source: ColorBrewer's RdBu, Harrower and Brewer, 2003: told apart by colour-blind eyes too.
"""

COLOURED_SHARE = 0.98
"""Of the hull's vertices that the colours reach to; beyond they stay at their ends."""

_log = logging.getLogger("radarhull")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Reference:
    """A body that the hull is held against.

    Attributes:
        surface: in its attitude, target frame.
        is_closed: whether it has an inside.
    """

    surface: Surface
    is_closed: bool = True


def reference_of(
    mesh: trimesh.Trimesh, attitude_wxyz: Sequence[float], offset_m: Sequence[float]
) -> Reference:
    """Return a mesh in its attitude: turned by a quaternion, then moved.

    Args:
        mesh: along its file's own axes, in metres.
        attitude_wxyz: (4,) rotation from the file's axes to the target frame, of any length.
        offset_m: (3,) target frame.

    Raises:
        ValueError: a quaternion without length or direction, or numbers that are not finite.
    """
    quaternion = np.array(attitude_wxyz, dtype=np.float64)
    if not (np.all(np.isfinite(quaternion)) and np.linalg.norm(quaternion) > 0):
        raise ValueError(
            "--reference-attitude wants a quaternion w x y z of finite numbers that are not all "
            f"zero; got {list(attitude_wxyz)}. No rotation is 1 0 0 0."
        )
    surface = Surface(vertices_m=mesh.vertices, faces=mesh.faces)
    rotation = Rotation.from_quat(np.roll(quaternion, -1)).as_matrix()
    turned = placed(surface, rotation=rotation, translation_m=np.array(offset_m))
    return Reference(surface=turned, is_closed=bool(mesh.is_watertight))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Compared:
    """A hull that was held against the reference.

    Attributes:
        surface: of the hull.
        revision: of the hull.
        comparison: what came out.
        mean_m, rms_m: of the signed distance over the hull's area, outside positive.
        limit_m: signed distance at which the colours end.
    """

    surface: Surface
    revision: int
    comparison: ReferenceComparison
    mean_m: float
    rms_m: float
    limit_m: float

    def colours(self) -> NDArray[np.uint8]:
        """Return the colour of each of the hull's vertices by its distance, (vertices, 3)."""
        return distance_colours(self.comparison.signed_distances_m / self.limit_m)


def distance_colours(shares: Floats) -> NDArray[np.uint8]:
    """Return the colours (n, 3) of distances as shares of the colours' limit, −1 … 1."""
    table = [[int(text[place : place + 2], 16) for place in (1, 3, 5)] for text in DISTANCE_COLOURS]
    at = np.linspace(-1, 1, len(table))
    mixed = [np.interp(shares, at, np.array(table)[:, part]) for part in range(3)]
    colours: NDArray[np.uint8] = np.round(np.stack(mixed, axis=1)).astype(np.uint8)
    return colours


def compared(hull: Surface, reference: Surface, *, revision: int, spacing_m: float) -> Compared:
    """Hold a hull against a reference.

    Raises:
        ValueError: an empty surface, or too fine a spacing.
    """
    comparison = compare(hull, reference, spacing_m=spacing_m)
    signed = comparison.signed_distances_m
    weights = _vertex_areas_m2(hull)
    return Compared(
        surface=hull,
        revision=revision,
        comparison=comparison,
        mean_m=float(np.average(signed, weights=weights)),
        rms_m=float(np.sqrt(np.average(signed**2, weights=weights))),
        limit_m=_rounded_up(float(np.quantile(np.abs(signed), COLOURED_SHARE))),
    )


def _vertex_areas_m2(surface: Surface) -> Floats:
    areas = np.linalg.norm(area_vectors_m2(surface), axis=1)
    summed: Floats = np.zeros(len(surface.vertices_m))
    for corner in range(3):
        np.add.at(summed, surface.faces[:, corner], areas / 3)
    return summed


def _rounded_up(limit_m: float) -> float:
    """Return the next round length, at least a millimetre."""
    limit_m = max(limit_m, 1e-3)
    power = 10.0 ** np.floor(np.log10(limit_m))
    steps = power * np.array([1, 1.5, 2, 3, 4, 5, 6, 8, 10])
    # Rounding must not make of 0.1 the next longer.
    return float(steps[steps >= (1 - 1e-9) * limit_m][0])


class ReferenceDesk:
    """Compares the hull on show with a reference when it is asked to; one comparison at a time."""

    def __init__(
        self,
        reference: Surface,
        snapshot: Callable[[], Snapshot],
        show: Callable[[Compared | None], None],
        changed: Callable[[], None],
        *,
        is_closed: bool = True,
    ) -> None:
        """Compare nothing yet.

        Args:
            reference: in its attitude.
            snapshot: gives what is on show.
            show: is called with what is to be coloured, None to take it off.
            changed: is called after every change of the facts.
            is_closed: whether the reference has an inside.
        """
        self._reference = reference
        self._snapshot = snapshot
        self._show = show
        self._changed = changed
        self._lock = threading.Lock()
        self._thread: threading.Thread | None = None
        self._compared: Compared | None = None
        self._is_coloured = False
        self._complaint = "" if is_closed else _NOT_CLOSED

    def request(self) -> None:
        """Begin to compare the hull on show, unless that is under way."""
        with self._lock:
            if self._thread is not None:
                return
            self._thread = threading.Thread(target=self._work, name="reference", daemon=True)
            self._thread.start()
        self._changed()

    def note(self, snapshot: Snapshot) -> None:
        """Take the colours off as soon as another hull is on show: they are not its."""
        with self._lock:
            done = self._compared
            if not self._is_coloured or done is None or snapshot.surface is done.surface:
                return
            self._is_coloured = False
            self._show(None)

    def facts(self) -> dict[str, Any]:
        """Return what is known, as the page shows it."""
        with self._lock:
            return {
                "is_running": self._thread is not None,
                "is_coloured": self._is_coloured,
                "complaint": self._complaint,
                "comparison": None if self._compared is None else _facts(self._compared),
            }

    def wait(self, timeout_s: float) -> None:
        """Wait for a comparison that is under way."""
        thread = self._thread
        if thread is not None:
            thread.join(timeout_s)

    def _work(self) -> None:
        snapshot, done, complaint = self._snapshot(), None, ""
        try:
            done = self._compare(snapshot)
        except ValueError as error:
            complaint = str(error)
        except Exception as error:  # the thread must not die silently
            _log.exception("The hull could not be compared with the reference.")
            complaint = f"The hull could not be compared: {type(error).__name__}: {error}"
        with self._lock:
            self._thread = None
            if done is None:
                self._complaint = complaint
            else:
                self._compared = done
                self._is_coloured = self._snapshot().surface is done.surface
                self._show(done if self._is_coloured else None)
        self._changed()

    def _compare(self, snapshot: Snapshot) -> Compared:
        hull, surface = snapshot.hull, snapshot.surface
        if hull is None or surface is None:
            raise ValueError("There is no hull yet, so there is nothing to compare.")
        if hull.is_preview:
            raise ValueError("The outline on show is not kept yet; compare again once it is.")
        return compared(
            surface,
            self._reference,
            revision=hull.revision,
            spacing_m=snapshot.settings.spacing_m,
        )


_NOT_CLOSED = (
    "The reference mesh is not closed, so it has no certain inside: signs and the intersection may "
    "be wrong."
)


def _facts(done: Compared) -> dict[str, Any]:
    found = done.comparison
    return {
        "revision": done.revision,
        "intersection_over_union": found.intersection_over_union,
        "chamfer_m": found.chamfer_m,
        "hausdorff_m": found.hausdorff_m,
        "mean_m": done.mean_m,
        "rms_m": done.rms_m,
        "outside_m": float(max(found.signed_distances_m.max(), 0.0)),
        "inside_m": float(min(found.signed_distances_m.min(), 0.0)),
        "limit_m": done.limit_m,
        "colours": DISTANCE_COLOURS,
    }
