"""Measurements in the viewport: drawn as they are measured, their ends draggable on the hull."""

import threading
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
import viser
from viser import SceneNodeDragEvent

from app.measured_items import Item
from app.measurement_shapes import (
    Arrows,
    End,
    Label,
    Lines,
    Shape,
    ShownHull,
    Tint,
    shapes_of,
)
from app.measuring import MeasurementDesk
from app.picking import surface_anchor
from app.snapshot import Snapshot
from core.arrays import Floats
from core.hull.closed_mesh import Surface
from core.measurement.anchors import Anchor
from core.measurement.picking import first_hit_m
from core.measurement.specs import Length, LineFeature, Polyline, Spec

Handle = (
    viser.LineSegmentsHandle
    | viser.IcosphereHandle
    | viser.ArrowsHandle
    | viser.LabelHandle
    | viser.MeshHandle
)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Drag:
    """An end that somebody drags: of which measurement, and where it now is on the hull."""

    node: str
    name: str
    number: int
    place_m: Floats


class MeasurementDrawing:
    """Keeps the measurements of a desk in a viser scene; only nodes that change are sent."""

    def __init__(
        self,
        server: viser.ViserServer,
        desk: MeasurementDesk,
    ) -> None:
        """Show nothing yet.

        Args:
            server: whose scene it is.
            desk: whose measurements are drawn, and take the ends that are dragged.
        """
        self._server = server
        self._desk = desk
        # Measurements come from the desk's thread, hulls from the live loop, drags from viser's.
        self._lock = threading.Lock()
        self._hull: ShownHull | None = None
        self._shapes: dict[str, Shape] = {}
        self._handles: dict[str, Handle] = {}
        self._numbers: dict[str, int] = {}
        self._drag: _Drag | None = None

    def note(self, snapshot: Snapshot) -> None:
        """Take notice of the hull on show: what was measured on another turns grey."""
        hull, surface = snapshot.hull, snapshot.surface
        with self._lock:
            if hull is None or surface is None:
                self._hull = None
            elif self._hull is None or surface is not self._hull.surface:
                self._hull = ShownHull(
                    surface=surface, revision=hull.revision, is_preview=hull.is_preview
                )
            elif (hull.revision, hull.is_preview) == (
                self._hull.revision,
                self._hull.is_preview,
            ):
                return
            else:
                self._hull = replace(self._hull, revision=hull.revision, is_preview=hull.is_preview)
            self._draw(self._desk.items)

    def show(self, items: Sequence[Item]) -> None:
        """Bring the drawing up to date with the desk."""
        with self._lock:
            self._draw(items)

    def _draw(self, items: Sequence[Item]) -> None:
        wanted = self._wanted(items)
        gone = [node for node in self._shapes if node not in wanted]
        new = {n: s for n, s in wanted.items() if not _is_same(self._shapes.get(n), s)}
        if not gone and not new:
            return
        with self._server.atomic():
            for node in gone:
                del self._shapes[node]
                self._handles.pop(node).remove()
            for node, shape in new.items():
                self._put(node, shape)
        self._server.flush()

    def _wanted(self, items: Sequence[Item]) -> dict[str, Shape]:
        """Return every node's shape by name; names of measurements are no names of nodes."""
        names = {item.spec.name for item in items}
        self._numbers = {name: n for name, n in self._numbers.items() if name in names}
        wanted: dict[str, Shape] = {}
        for item in items:
            number = self._number(item.spec.name)
            if self._hull is not None:
                shapes = shapes_of(item, self._hull)
                wanted |= {f"/measurements/{number}-{part}": s for part, s in shapes.items()}
        return wanted

    def _number(self, name: str) -> int:
        taken = set(self._numbers.values())
        free = next(number for number in range(len(taken) + 1) if number not in taken)
        return self._numbers.setdefault(name, free)

    def _put(self, node: str, shape: Shape) -> None:
        self._shapes[node] = shape
        handle = self._handles.get(node)
        if handle is None or not _is_updated(handle, shape):
            self._handles[node] = self._made(node, shape)

    def _made(self, node: str, shape: Shape) -> Handle:
        scene = self._server.scene
        if isinstance(shape, Lines):
            return scene.add_line_segments(
                node,
                shape.points_m.astype(np.float32),
                shape.colour,
                thickness=shape.width_px,
                thickness_units="screen",
            )
        if isinstance(shape, Arrows):
            return scene.add_arrows(
                node,
                shape.points_m.astype(np.float32),
                shape.colour,
                shaft_radius=shape.radius_m,
                head_radius=3 * shape.radius_m,
                head_length=8 * shape.radius_m,
            )
        if isinstance(shape, Label):
            return scene.add_label(node, shape.text, position=shape.place_m, anchor=shape.anchor)
        if isinstance(shape, Tint):
            return scene.add_mesh_simple(
                node,
                vertices=shape.surface.vertices_m,
                faces=shape.surface.faces,
                color=shape.colour,
                opacity=0.6,
                side="double",
                cast_shadow=False,
                receive_shadow=False,
            )
        return self._end(node, shape)

    def _end(self, node: str, shape: End) -> viser.IcosphereHandle:
        ball = self._server.scene.add_icosphere(
            node,
            radius=shape.radius_m,
            color=shape.colour,
            position=shape.place_m,
            cast_shadow=False,
            receive_shadow=False,
        )

        # viser keeps the order of a drag's phases only where it can wait for the callback.
        async def dragged(event: SceneNodeDragEvent[viser.IcosphereHandle]) -> None:
            camera_m = np.array(event.client.camera.position)
            self.drag(node, event.phase, camera_m, np.array(event.end_position) - camera_m)

        ball.on_drag("left")(dragged)
        return ball

    def drag(self, node: str, phase: str, origin_m: Floats, direction: Floats) -> None:
        """Move an end along the hull while it is dragged, and measure anew once it is let go.

        It stays at its last place on the hull where the pointer leaves it.

        Args:
            node: of the end.
            phase: "start", "update" or "end".
            origin_m: (3,) of the ray through the pointer, target frame.
            direction: (3,) of the ray.
        """
        with self._lock:
            if phase == "start":
                self._drag = self._begun(node)
            drag, hull = self._drag, self._hull
            if drag is None or drag.node != node or hull is None:
                return
            place = first_hit_m(hull.surface, origin_m, direction)
            if place is not None:
                self._drag = drag = replace(drag, place_m=place)
                self._move(drag)
            if phase != "end":
                return
            self._drag = None
        self._let_go(drag, hull)

    def _begun(self, node: str) -> _Drag | None:
        shape = self._shapes.get(node)
        number = int(node.removeprefix("/measurements/").split("-")[0])
        names = [name for name, its in self._numbers.items() if its == number]
        if not isinstance(shape, End) or not names:
            return None
        return _Drag(node=node, name=names[0], number=shape.number, place_m=shape.place_m)

    def _move(self, drag: _Drag) -> None:
        """Let the ball, the line that it ends and the label follow the pointer."""
        stem = drag.node.removesuffix(f"end-{drag.number}")
        ends = {
            end.number: end.place_m
            for node, end in self._shapes.items()
            if node.startswith(f"{stem}end-") and isinstance(end, End)
        }
        points = np.array([{**ends, drag.number: drag.place_m}[number] for number in sorted(ends)])
        moved: dict[str, Shape] = {}
        for node in (drag.node, f"{stem}lines", f"{stem}label"):
            if (shape := self._shapes.get(node)) is not None:
                moved[node] = _dragged(shape, drag, points)
        with self._server.atomic():
            for node, shape in moved.items():
                self._put(node, shape)
        self._server.flush()

    def _let_go(self, drag: _Drag, hull: ShownHull) -> None:
        """Measure to where an end was dragged; what was measured otherwise meanwhile stays so."""
        spec = next((i.spec for i in self._desk.items if i.spec.name == drag.name), None)
        if spec is not None:
            anchor = surface_anchor(hull.surface, drag.place_m)
            self._desk.replace(drag.name, with_anchor(spec, drag.number, anchor))


def _dragged(shape: Shape, drag: _Drag, points_m: Floats) -> Shape:
    """Return a part of a measurement whose ends are now at (n, 3)."""
    steps = np.stack([points_m[:-1], points_m[1:]], axis=1)
    if isinstance(shape, Lines):
        return replace(shape, points_m=steps)
    if isinstance(shape, Label):
        length_m = float(np.linalg.norm(steps[:, 1] - steps[:, 0], axis=1).sum())
        return replace(shape, text=f"{drag.name} {length_m:.2f} m", place_m=steps[0].mean(axis=0))
    return replace(shape, place_m=drag.place_m) if isinstance(shape, End) else shape


def _is_same(one: Shape | None, other: Shape) -> bool:
    if type(one) is not type(other):
        return False
    return all(_equal(getattr(one, f.name), getattr(other, f.name)) for f in fields(other))


def _equal(one: object, other: object) -> bool:
    if isinstance(one, Surface) and isinstance(other, Surface):
        return np.array_equal(one.vertices_m, other.vertices_m) and np.array_equal(
            one.faces, other.faces
        )
    return np.array_equal(one, other)  # type: ignore[arg-type]


def _is_updated(handle: Handle, shape: Shape) -> bool:
    """Change a node to another shape of its kind, and tell whether that could be done."""
    if isinstance(shape, Lines) and isinstance(handle, viser.LineSegmentsHandle):
        handle.points = shape.points_m.astype(np.float32)
        handle.colors = np.array(shape.colour, dtype=np.uint8)
    elif isinstance(shape, Label) and isinstance(handle, viser.LabelHandle):
        handle.text, handle.position, handle.anchor = shape.text, shape.place_m, shape.anchor
    elif isinstance(shape, End) and isinstance(handle, viser.IcosphereHandle):
        handle.position, handle.color, handle.radius = shape.place_m, shape.colour, shape.radius_m
    else:
        return False
    return True


def with_anchor(spec: Spec, number: int, anchor: Anchor) -> Spec:
    """Return a length, a line feature or a polyline with another anchor.

    Raises:
        ValueError: a spec without ends.
    """
    if isinstance(spec, Length | LineFeature):
        return replace(spec, start=anchor) if number == 0 else replace(spec, end=anchor)
    if isinstance(spec, Polyline):
        anchors = (*spec.anchors[:number], anchor, *spec.anchors[number + 1 :])
        return replace(spec, anchors=anchors)
    raise ValueError(f'"{spec.name}" has no ends that could be moved.')
