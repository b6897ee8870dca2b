"""What the workstation shows at one moment, as one immutable value."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from core.analysis.frames import AnalysedFrame
from core.analysis.hull import Hull
from core.analysis.hulls import PartHull
from core.frame import Frame
from core.hull.simplification import Simplified
from core.hull.surface import Surface
from core.measurement.components import ComponentPlace
from core.measurement.residuals import Residual
from core.reconstruction import ReconstructionSettings
from core.silhouettes.silhouette import WHOLE, Silhouette

Status = Literal["empty", "preparing", "playing", "paused", "finished", "failed"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Record:
    """A frame as it stands, and what the hull was when it had come.

    Attributes:
        analysed: the frame, its outline and its state now.
        hull: after it came; its revision tells it from the present one.
    """

    analysed: AnalysedFrame
    hull: Hull

    @property
    def number(self) -> int:
        """How many frames had come, this one included."""
        return self.analysed.number

    @property
    def frame(self) -> Frame:
        """The frame that came."""
        return self.analysed.frame

    @property
    def silhouette(self) -> Silhouette:
        """Its outline."""
        return self.analysed.silhouette


@dataclass(frozen=True, slots=True, kw_only=True)
class HullResiduals:
    """How each frame and a hull disagree.

    Attributes:
        revision: of that hull, which may not be the present one any more.
        frames: one per frame that had come, oldest first.
    """

    revision: int
    frames: tuple[Residual, ...]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PartPlace:
    """Where a part's hull stands in the whole target's.

    Attributes:
        revision: of the part's hull.
        whole_revision: of the whole's; neither may be the present one any more.
        place: of the one in the other.
    """

    revision: int
    whole_revision: int
    place: ComponentPlace


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Snapshot:
    """All that observers may show, consistent in itself.

    Attributes:
        run: grows with every restart, so that frame 3 of one run is not taken for another's.
        serial: grows with every change, so that an answer that arrives late is known as old.
        status: what the live loop is doing.
        message: why it failed, empty otherwise.
        speed_hz: frames per second, None for as fast as they are computed.
        settings: by which the hull is carved.
        records: one per frame so far, oldest first.
        hull: what is known of the hull of all of them, None before the first.
        surface: of that hull, None before the first frame.
        parts: hulls of the target's parts that have an outline in some frame, by label.
        outlined: labels of all that has ever been outlined, in the order in which it first was.
        light: the same with fewer faces for the browser to draw once nothing changes it, None
            until then and where the hull has few enough.
        residuals: of the latest hull that was quiet long enough, None before one.
        places: of parts in the whole, by label, found once their hulls had been quiet for a while.
        chosen: number of the frame that the analyst picked, None to follow the latest.
        latency_ms: from the last edit's arrival until its hull could be shown, None before one.
    """

    run: int
    serial: int = 0
    status: Status
    message: str = ""
    speed_hz: float | None
    settings: ReconstructionSettings
    records: tuple[Record, ...] = ()
    hull: Hull | None = None
    surface: Surface | None = None
    parts: tuple[PartHull, ...] = ()
    outlined: tuple[str, ...] = (WHOLE,)
    light: Simplified | None = None
    residuals: HullResiduals | None = None
    places: Mapping[str, PartPlace] = field(default_factory=dict)
    chosen: int | None = None
    latency_ms: float | None = None

    @property
    def shown(self) -> Record | None:
        """The frame to show: the chosen one, else the latest."""
        if not self.records:
            return None
        return self.records[-1 if self.chosen is None else self.chosen - 1]

    @property
    def is_preview(self) -> bool:
        """Whether a hull follows an outline that is not kept."""
        hulls = [self.hull, *(part.hull for part in self.parts)]
        return any(hull is not None and hull.is_preview for hull in hulls)

    @property
    def components(self) -> tuple[str, ...]:
        """Labels of what has a hull of its own, the whole target first."""
        return (WHOLE, *(part.label for part in self.parts))

    def place_of(self, part: PartHull) -> ComponentPlace | None:
        """Return where a part is in the whole; None where that is not known of these hulls."""
        found = self.places.get(part.label)
        if found is None or self.hull is None:
            return None
        is_current = (found.revision, found.whole_revision) == (
            part.hull.revision,
            self.hull.revision,
        )
        return found.place if is_current else None

    def carved(self, component: str) -> tuple[Hull, Surface] | None:
        """Return the hull of a component with its surface, None where it has none."""
        if component == WHOLE:
            if self.hull is None or self.surface is None:
                return None
            return self.hull, self.surface
        return next(((p.hull, p.surface) for p in self.parts if p.label == component), None)

    @property
    def drawn(self) -> Surface | None:
        """The surface that the browser draws."""
        return self.surface if self.light is None else self.light.surface
