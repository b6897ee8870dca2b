"""The scene in the viewport: hull, current frame in its imaging plane, line of sight, axes."""

from dataclasses import dataclass

import numpy as np
import viser
from numpy.typing import NDArray
from viser import transforms

from app.pictures import SHOWN_FLOOR_DB, translucent_picture
from app.snapshot import Record, Snapshot
from core.analysis.frames import AnalysedFrame
from core.arrays import Floats
from core.frame import Frame
from core.hull.surface import Surface
from core.silhouettes.silhouette import Silhouette

HULL_COLOUR = (168, 184, 204)
OUTLINE_COLOUR = (64, 224, 208)
SIGHT_COLOUR = (240, 140, 20)
PLANE_COLOUR = (96, 110, 135)
AXIS_COLOURS = ((214, 48, 48), (64, 160, 48), (48, 104, 235))
"""More saturated than the page's, for the lights wash them out."""
AXIS_NAMES = ("x along-track", "y cross-track", "z nadir")

GRID_CELL_M = 1.0
GRID_SECTION_M = 5.0

SIGHT_REACH = (0.58, 0.42)
"""Where the arrow of the line of sight begins and ends, in sides of the window from the centre."""

PICTURE_GAP_M = 0.6
"""Between the hull and the picture beside it."""

PICTURE_MARGIN_M = 1.5
"""Shown of a frame around its silhouette."""

CAMERA_DIRECTION = np.array([0.62, -0.66, -0.42])
"""From the target towards the default camera: ahead of it, to its side and above (−z is up)."""

CAMERA_FIELD_OF_VIEW_RAD = np.radians(36.0)


@dataclass(frozen=True, slots=True)
class PicturePlane:
    """Where a parallel image stands in space.

    Attributes:
        centre_m: (3,) of the picture, target frame.
        right, down: (3,) unit vectors of growing columns and growing rows.
        aside_m: (3,) by how much the picture stands beside its plane through the origin.
        rows, columns: slices of the image that lie within the window.
        width_m, height_m: size of the picture.
    """

    centre_m: Floats
    right: Floats
    down: Floats
    aside_m: Floats
    rows: slice
    columns: slice
    width_m: float
    height_m: float

    def quaternion_wxyz(self) -> NDArray[np.float64]:
        """Return the rotation from the picture's axes (right, down, into it) to the target's."""
        axes = np.column_stack([self.right, self.down, np.cross(self.right, self.down)])
        return np.asarray(transforms.SO3.from_matrix(axes).wxyz, dtype=np.float64)

    def border_m(self) -> Floats:
        """Return the four corners of the picture, (4, 3)."""
        across, along = 0.5 * self.width_m * self.right, 0.5 * self.height_m * self.down
        corners = [-across - along, across - along, across + along, along - across]
        border: Floats = self.centre_m + np.array(corners)
        return border


class Viewport:
    """Keeps a viser scene in step with the snapshots it is given.

    Nodes are kept and updated: viser's clients make new ones from scratch, and a new picture is
    white until the browser has decoded it. Only what a snapshot changes is sent.
    """

    def __init__(self, server: viser.ViserServer) -> None:
        """Set up an empty scene."""
        self._server = server
        self._side_m = 0.0
        self._hull_shown: Surface | None = None
        self._frame_shown: AnalysedFrame | None = None
        self._picture_shown: tuple[Frame, slice, slice] | None = None
        self._aspects_shown: tuple[Frame, ...] = ()
        self._hull: viser.MeshHandle | None = None
        self._picture = server.scene.add_image(
            "/picture",
            np.zeros((2, 2, 4), dtype=np.uint8),
            render_width=1e-3,
            render_height=1e-3,
            format="png",
            cast_shadow=False,
            receive_shadow=False,
        )

    def show(self, snapshot: Snapshot) -> None:
        """Bring the scene up to date; does nothing for what is already there."""
        with self._server.atomic():
            is_resized = snapshot.settings.side_m != self._side_m
            if is_resized:
                self._resize(snapshot.settings.side_m)
            hull_is_new = snapshot.drawn is not self._hull_shown
            if hull_is_new:
                self._show_hull(snapshot.drawn)
            self._show_aspects(snapshot.records, again=is_resized)
            shown = None if snapshot.shown is None else snapshot.shown.analysed
            if shown is not self._frame_shown or is_resized:
                self._show_frame(shown)
            elif shown is not None and hull_is_new:
                self._show_picture(shown)
        self._server.flush()  # viser else gathers messages for a sixtieth of a second

    def _resize(self, side_m: float) -> None:
        self._side_m = side_m
        self._prepare_view()
        self._add_reference()

    def _prepare_view(self) -> None:
        server = self._server
        server.gui.configure_theme(dark_mode=True, show_logo=False, show_share_button=False)
        server.scene.configure_environment_map(None)
        server.scene.configure_default_lights(enabled=True, cast_shadow=False)
        server.scene.add_light_ambient("/light/ambient", intensity=0.5)
        server.scene.set_up_direction("-z")
        distance_m = 0.5 * self._side_m / np.tan(0.5 * CAMERA_FIELD_OF_VIEW_RAD) * 1.3
        direction = CAMERA_DIRECTION / np.linalg.norm(CAMERA_DIRECTION)
        server.initial_camera.fov = float(CAMERA_FIELD_OF_VIEW_RAD)
        server.initial_camera.far = 40 * self._side_m
        server.initial_camera.position = direction * distance_m
        server.initial_camera.look_at = np.zeros(3)

    def _add_reference(self) -> None:
        half = 0.5 * self._side_m
        # Below the target as it is seen: nadir is down, so the grid lies at +z.
        self._server.scene.add_grid(
            "/reference/grid",
            width=2 * self._side_m,
            height=2 * self._side_m,
            plane="xy",
            position=(0.0, 0.0, half),
            cell_size=GRID_CELL_M,
            section_size=GRID_SECTION_M,
            cell_color=(38, 46, 60),
            section_color=(64, 76, 98),
            cell_thickness=0.6,
            section_thickness=1.0,
            fade_distance=6 * self._side_m,
            shadow_opacity=0.0,
        )
        for axis, (name, colour) in enumerate(zip(AXIS_NAMES, AXIS_COLOURS, strict=True)):
            tip = np.eye(3)[axis] * (half + 2)
            self._arrow(f"/reference/{name}", np.zeros(3), tip, colour, radius_m=0.06)
            self._label(f"/reference/{name}/label", name, tip * 1.04)

    def _show_hull(self, surface: Surface | None) -> None:
        self._hull_shown = surface
        if surface is None or surface.is_empty:
            if self._hull is not None:
                self._hull.visible = False
            return
        if self._hull is None:
            self._hull = self._server.scene.add_mesh_simple(
                "/hull",
                vertices=surface.vertices_m,
                faces=surface.faces,
                color=HULL_COLOUR,
                side="double",
                cast_shadow=False,
                receive_shadow=False,
            )
            return
        # Within one `atomic`, for vertices without their faces would be drawn as a tangle.
        self._hull.vertices = surface.vertices_m.astype(np.float32)
        self._hull.faces = surface.faces.astype(np.uint32)
        self._hull.visible = True

    def _show_frame(self, shown: AnalysedFrame | None) -> None:
        self._frame_shown = shown
        if shown is None:
            self._server.scene.remove_by_name("/frame")
            self._picture.visible = False
            return
        tail, tip = (-away * self._side_m * shown.frame.line_of_sight for away in SIGHT_REACH)
        self._arrow("/frame/sight", tail, tip, SIGHT_COLOUR, radius_m=0.12)
        self._label("/frame/sight/label", "line of sight", tail)
        self._show_picture(shown)

    def _show_picture(self, shown: AnalysedFrame) -> None:
        frame, silhouette = shown.frame, shown.silhouette
        plane = picture_plane(frame, silhouette, self._side_m, self._hull_shown)
        self._picture.visible = plane is not None
        self._server.scene.remove_by_name("/frame/outline")
        if plane is None:
            self._server.scene.remove_by_name("/frame/border")
            return
        if self._picture_shown != (frame, plane.rows, plane.columns):
            level = frame.decibels(floor_db=SHOWN_FLOOR_DB)[plane.rows, plane.columns]
            self._picture.image = translucent_picture(level, SHOWN_FLOOR_DB)
            self._picture_shown = frame, plane.rows, plane.columns
        self._picture.render_width = plane.width_m
        self._picture.render_height = plane.height_m
        self._picture.wxyz = plane.quaternion_wxyz()
        self._picture.position = plane.centre_m
        self._lines("/frame/border", [plane.border_m()], PLANE_COLOUR, 1.0)
        rings = [frame.projection.plane_points(ring) for ring in silhouette.rings]
        beside = [ring + plane.aside_m for ring in rings]
        self._lines("/frame/outline", beside, OUTLINE_COLOUR, 2.0)

    def _show_aspects(self, records: tuple[Record, ...], *, again: bool) -> None:
        """Mark from where each frame looked, as dots where its line of sight begins."""
        frames = tuple(record.frame for record in records)
        if frames == self._aspects_shown and not again:
            return
        self._aspects_shown = frames
        if not frames:
            self._server.scene.remove_by_name("/aspects")
            return
        sights = np.array([frame.line_of_sight for frame in frames])
        self._server.scene.add_point_cloud(
            "/aspects",
            points=(-SIGHT_REACH[0] * self._side_m * sights).astype(np.float32),
            colors=SIGHT_COLOUR,
            point_size=0.16,
            point_shape="circle",
        )

    def _lines(
        self, name: str, rings: list[Floats], colour: tuple[int, int, int], width_px: float
    ) -> None:
        if not rings:
            return
        segments = [np.stack([ring, np.roll(ring, -1, axis=0)], axis=1) for ring in rings]
        self._server.scene.add_line_segments(
            name,
            np.concatenate(segments).astype(np.float32),
            colour,
            thickness=width_px,
            thickness_units="screen",
        )

    def _arrow(
        self, name: str, tail: Floats, tip: Floats, colour: tuple[int, int, int], *, radius_m: float
    ) -> None:
        self._server.scene.add_arrows(
            name,
            np.array([[tail, tip]], dtype=np.float32),
            colour,
            shaft_radius=radius_m,
            head_radius=3 * radius_m,
            head_length=8 * radius_m,
        )

    def _label(self, name: str, text: str, position: Floats) -> None:
        self._server.scene.add_label(name, text, position=position, anchor="center-center")


def picture_plane(
    frame: Frame, silhouette: Silhouette, side_m: float, hull: Surface | None
) -> PicturePlane | None:
    """Return where a frame's picture stands, None for a perspective image.

    The picture is cut to the silhouette and a margin, or to the window of `side_m` around the
    target where nothing was found, and moved along its normal: in the plane through the target
    the hull would hide it.
    """
    if not frame.projection.is_affine:
        return None
    to_plane = frame.projection.plane_points
    corner, right_end, down_end = to_plane(np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]]))
    right, down = right_end - corner, down_end - corner
    size = float(np.linalg.norm(down)), float(np.linalg.norm(right))
    rows, columns = (
        slice(int(first), int(last) + 1)
        for first, last in zip(*_window(frame, silhouette, np.array(size), side_m), strict=True)
    )
    aside = _aside(frame.projection.viewing_direction(), side_m, hull)
    middle = np.array([0.5 * (cut.start + cut.stop - 1) for cut in (rows, columns)])
    return PicturePlane(
        centre_m=to_plane(middle) + aside,
        right=right / size[1],
        down=down / size[0],
        aside_m=aside,
        rows=rows,
        columns=columns,
        width_m=float((columns.stop - columns.start) * size[1]),
        height_m=float((rows.stop - rows.start) * size[0]),
    )


def _aside(normal: Floats, side_m: float, hull: Surface | None) -> Floats:
    """Return by how much (3,) to move a picture along its normal for the default camera to see it.

    Behind the hull; but a hull that is open there reaches the window's edge and would hide it, so
    then the picture stands before its near end, like the section that the hull continues.
    """
    away = -normal if normal @ CAMERA_DIRECTION > 0 else normal
    if hull is None or hull.is_empty:
        return 0.5 * side_m * away
    reach_m = hull.vertices_m @ away
    if reach_m.max() < 0.45 * side_m:
        return (float(reach_m.max()) + PICTURE_GAP_M) * away
    return (float(reach_m.min()) - PICTURE_GAP_M) * away


def _window(
    frame: Frame, silhouette: Silhouette, spacing_m: Floats, side_m: float
) -> tuple[Floats, Floats]:
    """Return the first and the last (row, column) of the part of a frame to show in space."""
    if silhouette.is_empty:
        origin = frame.projection.matrix[:, 3]
        first, last = origin - 0.5 * side_m / spacing_m, origin + 0.5 * side_m / spacing_m
    else:
        seen = np.concatenate(silhouette.rings)
        margin = PICTURE_MARGIN_M / spacing_m
        first, last = seen.min(axis=0) - margin, seen.max(axis=0) + margin
    end = np.array(frame.shape) - 1
    return np.clip(np.floor(first), 0, end - 1), np.clip(np.ceil(last), 1, end)
