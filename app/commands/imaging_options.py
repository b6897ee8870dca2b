"""Options of imaging, as the help shows them."""

from dataclasses import dataclass
from typing import Annotated, Literal

import tyro

from app.commands.options import OptionalFloat
from core.radar.focus import FocusCriterion
from core.radar.imaging import Method
from core.radar.refocusing import Autofocus
from core.radar.window import HAMMING, Window, taylor

MethodOption = Annotated[
    Method, tyro.conf.arg(metavar="{polar,keystone,range-doppler,backprojection}")
]
Divide = Literal["auto", "yes", "no"]


@dataclass(frozen=True)
class Weighing:
    """How both axes are weighed."""

    window: Literal["hamming", "taylor"] = "hamming"
    """Weighs both axes: hamming (sidelobes at −43 dB), or taylor with the two options below."""
    taylor_sidelobe_db: float = -35.0
    """Level of Taylor's near sidelobes, dB."""
    taylor_nbar: int = 5
    """Taylor's n̄: one more than the near sidelobes that are held to that level."""

    def chosen(self) -> Window:
        """Return the window that these options mean."""
        if self.window == "hamming":
            return HAMMING
        return taylor(sidelobe_db=self.taylor_sidelobe_db, nbar=self.taylor_nbar)


@dataclass(frozen=True)
class Focus:
    """Which intervals can be sharp."""

    target_radius_m: OptionalFloat = None
    """Largest distance of the target's scatterers from its origin, metres: intervals whose
    quadratic phase there exceeds π/4 are shortened or rejected. Without it, none is."""
    criterion: FocusCriterion = "angles"
    """What counts as quadratic phase: angles, θ̈ and φ̈ as in the paper, which name the zenith part
    of a pass; bending, which is all that polar format leaves; motion, all that plain
    range-Doppler leaves."""
    coarsest_resolution_m: OptionalFloat = None
    """Resolution to which intervals may be shortened, metres; three times --resolution-m unless
    given."""


@dataclass(frozen=True)
class Refocus:
    """What is found from the echoes alone before they are imaged."""

    autofocus: Annotated[
        Autofocus, tyro.conf.arg(metavar="{none,phase-gradient,minimum-entropy}")
    ] = "none"
    """What finds the pulses' phases in every coherent interval; minimum-entropy goes on from what
    phase-gradient finds. A shift of the image across cannot be found."""
    align: bool = False
    """First align the pulses' ranges, for an unknown translation of the target; each frame then
    shows the body's middle where the origin belongs."""


RefocusOptions = Annotated[Refocus, tyro.conf.arg(name="")]
WeighingOptions = Annotated[Weighing, tyro.conf.arg(name="")]
FocusOptions = Annotated[Focus, tyro.conf.arg(name="")]

DEFAULT_WEIGHING = Weighing()
DEFAULT_FOCUS = Focus()
DEFAULT_REFOCUS = Refocus()
