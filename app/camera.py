"""Where a viewport's camera stands: at home, far out on an axis, or as the radar looks."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from app.picture_plane import plane_axes
from core.arrays import Floats, frozen
from core.frame import Frame

HOME_DIRECTION = np.array([0.62, -0.66, -0.42])
"""From the target towards the camera at home: ahead of it, to its side and above (−z is up)."""

HOME_FIELD_OF_VIEW_RAD = np.radians(36.0)

HOME_MARGIN = 1.3
"""Height of what the camera at home sees at the target, in sides of the window."""

FAR_FIELD_OF_VIEW_RAD = np.radians(1.0)
"""Of axis views: viser has no orthographic camera, and from afar perspective all but vanishes."""

FAR_MARGIN = 1.45
"""The same as HOME_MARGIN for axis views: the window, and the names at the axes' tips."""

UP = np.array([0.0, 0.0, -1.0])
"""Nadir is down."""

POLE_TILT_RAD = 1e-4
"""By which views along z miss the pole, where an orbiting camera would not know which way is up."""

NEAREST_SHARE = 0.01
"""Distance of the near plane, in distances of the target: one may come a hundred times closer."""

FARTHEST_SHARE = 20.0

MOST_METRES = 1e7
"""That a camera may stand away from the target; beyond, single precision loses the scene."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Camera:
    """A camera of the viewport, in the target frame.

    Attributes:
        position_m: (3,) where it stands.
        look_at_m: (3,) what it looks at and turns around.
        up: (3,) direction that is up in its picture, not along the line of view.
        field_of_view_rad: angle from the picture's lower to its upper edge.
    """

    position_m: Floats
    look_at_m: Floats
    up: Floats
    field_of_view_rad: float

    def __post_init__(self) -> None:
        for name in ("position_m", "look_at_m", "up"):
            value = frozen(getattr(self, name), np.float64, (3,), f"A camera's {name}")
            object.__setattr__(self, name, value)
        if max(np.abs(self.position_m).max(), np.abs(self.look_at_m).max()) > MOST_METRES:
            raise ValueError(
                f"A camera stands within {MOST_METRES:.0e} m of the target; got {self.position_m}."
            )
        view = self.look_at_m - self.position_m
        if np.linalg.norm(np.cross(view, self.up)) <= 1e-9 * np.linalg.norm(view):
            raise ValueError(
                f"A camera at {self.position_m} that looks at {self.look_at_m} with {self.up} up "
                "sees nothing; it must look somewhere, and not along its up direction."
            )
        if not np.radians(0.1) <= self.field_of_view_rad <= np.radians(150.0):
            raise ValueError(
                "A camera's field of view lies between 0.1° and 150°; got "
                f"{np.degrees(self.field_of_view_rad):g}°."
            )

    @property
    def distance_m(self) -> float:
        """From what it looks at."""
        return float(np.linalg.norm(self.look_at_m - self.position_m))

    @property
    def near_m(self) -> float:
        """Nothing closer is drawn; it keeps the depth's precision where the target is."""
        return NEAREST_SHARE * self.distance_m

    @property
    def far_m(self) -> float:
        """Nothing farther is drawn."""
        return FARTHEST_SHARE * self.distance_m


@dataclass(frozen=True, slots=True, kw_only=True)
class NamedView:
    """A view that a button chooses.

    Attributes:
        name: of the button, as short as it is.
        hint: what it shows.
        camera: makes it for a window's side in metres, a picture's width over its height, and the
            frame on show.
    """

    name: str
    hint: str
    camera: Callable[[float, float, Frame | None], Camera]


def home_camera(side_m: float) -> Camera:
    """Return the camera that a page begins with, for a window of `side_m`."""
    distance_m = 0.5 * side_m / np.tan(0.5 * HOME_FIELD_OF_VIEW_RAD) * HOME_MARGIN
    return Camera(
        position_m=HOME_DIRECTION / np.linalg.norm(HOME_DIRECTION) * distance_m,
        look_at_m=np.zeros(3),
        up=UP,
        field_of_view_rad=float(HOME_FIELD_OF_VIEW_RAD),
    )


def far_camera(direction: Floats, up: Floats, side_m: float, aspect: float) -> Camera:
    """Return a far, narrow camera that looks at the target from a direction (3,).

    What lies a window's side behind something else is drawn smaller by 1.2 % where the picture is
    as wide as high, by less where it is narrower.
    """
    half_m = 0.5 * FAR_MARGIN * side_m / min(1.0, aspect)
    distance_m = half_m / np.tan(0.5 * FAR_FIELD_OF_VIEW_RAD)
    return Camera(
        position_m=direction / np.linalg.norm(direction) * distance_m,
        look_at_m=np.zeros(3),
        up=up,
        field_of_view_rad=float(FAR_FIELD_OF_VIEW_RAD),
    )


def sight_camera(side_m: float, aspect: float, frame: Frame | None) -> Camera:
    """Return the camera that looks as a frame's sensor does, its columns to the right.

    Raises:
        ValueError: there is no frame.
    """
    frame = _needed(frame)
    sight = frame.line_of_sight
    right = plane_axes(frame)[0] if frame.projection.is_affine else np.cross(UP, sight)
    across = right - (right @ sight) * sight
    up = np.cross(across, sight) if np.linalg.norm(across) > 1e-6 else np.array([1.0, 0.0, 0.0])
    return far_camera(-sight, up, side_m, aspect)


def plane_camera(side_m: float, aspect: float, frame: Frame | None) -> Camera:
    """Return the camera that sees the target as a frame is drawn: columns right, rows down.

    Raises:
        ValueError: there is no frame, or one in perspective.
    """
    frame = _needed(frame)
    if not frame.projection.is_affine:
        raise ValueError(
            "This frame is a perspective picture, which has no plane to look onto; take the view "
            "along its line of sight."
        )
    right, down = plane_axes(frame)
    return far_camera(-np.cross(right, down), -down, side_m, aspect)


def _needed(frame: Frame | None) -> Frame:
    if frame is None:
        raise ValueError("No frame has arrived yet, so there is nothing to look along.")
    return frame


def _from_axis(
    direction: tuple[int, int, int], side_m: float, aspect: float, _: Frame | None
) -> Camera:
    toward = np.array(direction, dtype=np.float64)
    # Above and below, x points up in the picture: the map has the flight's direction at its top.
    toward[0] += POLE_TILT_RAD * toward[2]
    return far_camera(toward, UP, side_m, aspect)


_FAR = "Far, narrow camera: at most 1.2 % of perspective over the window."

VIEWS = {
    view.name: view
    for view in (
        NamedView(
            name="home",
            hint="From ahead, the side and above, as the page begins",
            camera=lambda side_m, *_: home_camera(side_m),
        ),
        *(
            NamedView(name=name, hint=f"From {hint}. {_FAR}", camera=partial(_from_axis, direction))
            for name, hint, direction in (
                ("+x", "ahead, looking back along x", (1, 0, 0)),
                ("-x", "behind, looking along the flight", (-1, 0, 0)),
                ("+y", "the right of the flight", (0, 1, 0)),
                ("-y", "the left of the flight", (0, -1, 0)),
                ("+z", "below, x pointing up", (0, 0, 1)),
                ("-z", "above, x pointing up", (0, 0, -1)),
            )
        ),
        NamedView(
            name="sight",
            hint=f"Along this frame's line of sight, as the radar looks. {_FAR}",
            camera=sight_camera,
        ),
        NamedView(
            name="plane",
            hint=f"Onto this frame's plane, upright as the frame is drawn. {_FAR}",
            camera=plane_camera,
        ),
    )
}
"""In the order of their buttons."""
