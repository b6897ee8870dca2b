"""The scene in the viewport: hull, current frame in its imaging plane, line of sight, axes."""

import threading
from typing import Literal

import numpy as np
import viser

from app.camera import HOME_DIRECTION, UP, home_camera
from app.layers import (
    LAYERS,
    OUTLINE_COLOUR,
    PLANE_COLOUR,
    REFERENCE_COLOUR,
    SIGHT_COLOUR,
    UNCARVED_COLOUR,
    WIREFRAME_COLOUR,
    Colour,
)
from app.picture_plane import picture_plane
from app.pictures import SHOWN_FLOOR_DB, translucent_picture
from app.reference import Compared
from app.reference_glb import coloured_glb
from app.snapshot import Record, Snapshot
from app.surface_node import SurfaceNode
from app.viewport_parts import PartNodes
from core.analysis.frames import AnalysedFrame
from core.arrays import Floats
from core.frame import Frame
from core.hull.surface import Surface

AXIS_COLOURS = ((214, 48, 48), (64, 160, 48), (48, 104, 235))
"""More saturated than the page's, for the lights wash them out."""
AXIS_NAMES = ("x along-track", "y cross-track", "z nadir")

GRID_CELL_M = 1.0
GRID_SECTION_M = 5.0

HULL_OPACITY_AROUND_PARTS = 0.45

SIGHT_REACH = (0.58, 0.42)
"""Where the arrow of the line of sight begins and ends, in sides of the window from the centre."""


LabelAnchor = Literal["center-center", "bottom-left"]


class Viewport:
    """Keeps a viser scene in step with the snapshots it is given.

    Nodes are kept and updated: viser's clients make new ones from scratch, and a new picture is
    white until the browser has decoded it. Only what a snapshot changes is sent. Everything hangs
    below the node of its layer, which pages show and hide each for itself.
    """

    def __init__(self, server: viser.ViserServer, *, reference: Surface | None = None) -> None:
        """Set up a scene that holds nothing but the reference, in metres of the target frame."""
        self._server = server
        # Snapshots come from the live loop, wishes for layers from pages.
        self._lock = threading.Lock()
        self._side_m = 0.0
        self._wanted: frozenset[str] = frozenset()
        self._hull_shown: Surface | None = None
        self._frame_shown: AnalysedFrame | None = None
        self._picture_shown: tuple[Frame, slice, slice] | None = None
        self._aspects_shown: tuple[Frame, ...] = ()
        for layer in LAYERS:
            server.scene.add_frame(layer.node, show_axes=False, visible=layer.is_on)
        self._hull = SurfaceNode(server, "/hull/surface")
        self._parts = PartNodes(server, "/hull/parts")
        self._wireframe = SurfaceNode(
            server, "/wireframe/edges", colour=WIREFRAME_COLOUR, wireframe=True
        )
        self._uncarved = SurfaceNode(
            server, "/uncarved/surface", colour=UNCARVED_COLOUR, opacity=0.3
        )
        if reference is not None:
            node = SurfaceNode(server, "/reference/mesh", colour=REFERENCE_COLOUR, opacity=0.4)
            node.show(reference)
        self._picture = server.scene.add_image(
            "/picture/image",
            np.zeros((2, 2, 4), dtype=np.uint8),
            render_width=1e-3,
            render_height=1e-3,
            format="png",
            cast_shadow=False,
            receive_shadow=False,
        )

    def show(self, snapshot: Snapshot) -> None:
        """Bring the scene up to date; does nothing for what is already there."""
        with self._lock, self._server.atomic():
            is_resized = snapshot.settings.side_m != self._side_m
            if is_resized:
                self._resize(snapshot.settings.side_m)
            hull_is_new = snapshot.drawn is not self._hull_shown
            if hull_is_new:
                self._show_hull(snapshot.drawn)
            self._parts.show(snapshot)
            self._hull.fade(HULL_OPACITY_AROUND_PARTS if snapshot.parts else None)
            self._show_aspects(snapshot.records, again=is_resized)
            shown = None if snapshot.shown is None else snapshot.shown.analysed
            if shown is not self._frame_shown or is_resized:
                self._show_frame(shown)
            elif shown is not None and hull_is_new:
                self._show_picture(shown)
        self._server.flush()  # viser else gathers messages for a sixtieth of a second

    def want(self, layers: frozenset[str]) -> None:
        """Keep what costs much up to date only while a page shows one of its layers."""
        with self._lock, self._server.atomic():
            self._wanted = layers
            self._wireframe.show(self._hull_shown if "wireframe" in layers else None)
            if "uncarved" not in layers:
                self._uncarved.show(None)
        self._server.flush()

    def show_uncarved(self, surface: Surface) -> None:
        """Show the space that few views have carved away."""
        with self._lock, self._server.atomic():
            self._uncarved.show(surface if "uncarved" in self._wanted else None)
        self._server.flush()

    def show_distances(self, compared: Compared | None) -> None:
        """Show a hull in the colours of its distances from the reference, or take it off."""
        with self._lock, self._server.atomic():
            self._server.scene.remove_by_name("/distance/surface")
            if compared is not None:
                self._server.scene.add_glb(
                    "/distance/surface",
                    coloured_glb(compared),
                    cast_shadow=False,
                    receive_shadow=False,
                )
        self._server.flush()

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
        server.scene.set_up_direction(tuple(UP))
        home = home_camera(self._side_m)
        server.initial_camera.fov = home.field_of_view_rad
        server.initial_camera.near = home.near_m
        server.initial_camera.far = home.far_m
        server.initial_camera.position = home.position_m
        server.initial_camera.look_at = home.look_at_m

    def _add_reference(self) -> None:
        half = 0.5 * self._side_m
        # Below the target as it is seen: nadir is down, so the grid lies at +z.
        self._server.scene.add_grid(
            "/grid/plane",
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
            fade_from="origin",  # a far camera would see none of it
            shadow_opacity=0.0,
        )
        for axis, (name, colour) in enumerate(zip(AXIS_NAMES, AXIS_COLOURS, strict=True)):
            tip = np.eye(3)[axis] * (half + 2)
            self._arrow(f"/grid/{name}", np.zeros(3), tip, colour, radius_m=0.06)
            self._label(f"/grid/{name}/label", name, tip * 1.04)

    def _show_hull(self, surface: Surface | None) -> None:
        self._hull_shown = surface
        self._hull.show(surface)
        if "wireframe" in self._wanted:
            self._wireframe.show(surface)

    def _show_frame(self, shown: AnalysedFrame | None) -> None:
        self._frame_shown = shown
        if shown is None:
            for name in ("/sights/now", "/outline/rings", "/picture/border"):
                self._server.scene.remove_by_name(name)
            self._picture.visible = False
            return
        tail, tip = (-away * self._side_m * shown.frame.line_of_sight for away in SIGHT_REACH)
        self._arrow("/sights/now", tail, tip, SIGHT_COLOUR, radius_m=0.12)
        self._label("/sights/now/label", "line of sight", tail, anchor="bottom-left")
        self._show_picture(shown)

    def _show_picture(self, shown: AnalysedFrame) -> None:
        frame, silhouette = shown.frame, shown.silhouette
        plane = picture_plane(
            frame, silhouette, self._side_m, self._hull_shown, camera_direction=HOME_DIRECTION
        )
        self._picture.visible = plane is not None
        self._server.scene.remove_by_name("/outline/rings")
        if plane is None:
            self._server.scene.remove_by_name("/picture/border")
            return
        if self._picture_shown != (frame, plane.rows, plane.columns):
            level = frame.decibels(floor_db=SHOWN_FLOOR_DB)[plane.rows, plane.columns]
            self._picture.image = translucent_picture(level, SHOWN_FLOOR_DB)
            self._picture_shown = frame, plane.rows, plane.columns
        self._picture.render_width = plane.width_m
        self._picture.render_height = plane.height_m
        self._picture.wxyz = plane.quaternion_wxyz()
        self._picture.position = plane.centre_m
        self._lines("/picture/border", [plane.border_m()], PLANE_COLOUR, 1.0)
        rings = [frame.projection.plane_points(ring) for ring in silhouette.rings]
        beside = [ring + plane.aside_m for ring in rings]
        self._lines("/outline/rings", beside, OUTLINE_COLOUR, 2.0)

    def _show_aspects(self, records: tuple[Record, ...], *, again: bool) -> None:
        """Mark from where each frame looked, as dots where its line of sight begins."""
        frames = tuple(record.frame for record in records)
        if frames == self._aspects_shown and not again:
            return
        self._aspects_shown = frames
        if not frames:
            self._server.scene.remove_by_name("/sights/all")
            return
        sights = np.array([frame.line_of_sight for frame in frames])
        self._server.scene.add_point_cloud(
            "/sights/all",
            points=(-SIGHT_REACH[0] * self._side_m * sights).astype(np.float32),
            colors=SIGHT_COLOUR,
            point_size=0.16,
            point_shape="circle",
        )

    def _lines(self, name: str, rings: list[Floats], colour: Colour, width_px: float) -> None:
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
        self, name: str, tail: Floats, tip: Floats, colour: Colour, *, radius_m: float
    ) -> None:
        self._server.scene.add_arrows(
            name,
            np.array([[tail, tip]], dtype=np.float32),
            colour,
            shaft_radius=radius_m,
            head_radius=3 * radius_m,
            head_length=8 * radius_m,
        )

    def _label(
        self, name: str, text: str, position: Floats, *, anchor: LabelAnchor = "center-center"
    ) -> None:
        self._server.scene.add_label(name, text, position=position, anchor=anchor)
