"""What the workstation shows at one moment, as one immutable value."""

from dataclasses import dataclass
from typing import Literal

from core.arrays import Floats
from core.frame import Frame
from core.hull.simplification import Simplified
from core.hull.surface import Surface
from core.measurement.extents import Extent
from core.measurement.lines import LineMeasurement
from core.reconstruction import Step
from core.silhouettes.silhouette import Silhouette

Status = Literal["preparing", "playing", "paused", "finished", "failed"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Record:
    """What is kept of a step: everything but the surface, which only the latest hull needs.

    Attributes:
        number: how many frames had come, this one included.
        voting: how many of them voted.
        frame: the frame that came.
        silhouette: its outline.
        note: what a person should know of this frame, empty if nothing.
        extents: of the hull after it; empty when the hull is.
        lines: principal lines of the hull after it; empty while an extent of it is open.
        unobserved: (3,) direction that no frame up to this one constrains, or None.
        vertex_count, face_count: of the hull after it.
        volume_m3: of the hull after it.
    """

    number: int
    voting: int
    frame: Frame
    silhouette: Silhouette
    note: str
    extents: tuple[Extent, ...]
    lines: tuple[LineMeasurement, ...]
    unobserved: Floats | None
    vertex_count: int
    face_count: int
    volume_m3: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Snapshot:
    """All that observers may show, consistent in itself.

    Attributes:
        run: grows with every restart, so that frame 3 of one run is not taken for another's.
        serial: grows with every change, so that an answer that arrives late is known as old.
        status: what the live loop is doing.
        message: why it failed, empty otherwise.
        speed_hz: frames per second, None for as fast as they are computed.
        records: one per frame so far, oldest first.
        surface: the hull of all of them, None before the first.
        light: the same with fewer faces for the browser to draw once no more frames come, None
            until then and where the hull has few enough.
        chosen: number of the frame that the analyst picked, None to follow the latest.
    """

    run: int
    serial: int = 0
    status: Status
    message: str = ""
    speed_hz: float | None
    records: tuple[Record, ...] = ()
    surface: Surface | None = None
    light: Simplified | None = None
    chosen: int | None = None

    @property
    def shown(self) -> Record | None:
        """The frame to show: the chosen one, else the latest."""
        if not self.records:
            return None
        return self.records[-1 if self.chosen is None else self.chosen - 1]

    @property
    def drawn(self) -> Surface | None:
        """The surface that the browser draws."""
        return self.surface if self.light is None else self.light.surface

    @property
    def hull(self) -> Record | None:
        """The record that describes the current hull."""
        return self.records[-1] if self.records else None


def record_of(step: Step) -> Record:
    """Return what is kept of a step."""
    return Record(
        number=step.number,
        voting=step.voting,
        frame=step.frame,
        silhouette=step.silhouette,
        note=step.note,
        extents=step.extents,
        lines=step.lines,
        unobserved=step.unobserved,
        vertex_count=len(step.surface.vertices_m),
        face_count=len(step.surface.faces),
        volume_m3=step.surface.volume_m3(),
    )
