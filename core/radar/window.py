"""Windows that weigh both axes of an image, and the point responses that they leave."""

import re
from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.optimize import brentq

from core.arrays import Floats

LONGEST_RESPONSE_CELLS = 40.0
"""How far from its peak a point response is searched for its highest sidelobe."""

SIDELOBES_DB = (-80.0, -20.0)
LARGEST_NBAR = 20

_TAYLOR = re.compile(r"taylor (-?\d+(?:\.\d+)?) dB nbar (\d+)")


@dataclass(frozen=True, slots=True, kw_only=True)
class Window:
    """A sum of cosines across the aperture.

    Attributes:
        name: "hamming", or "taylor -35 dB nbar 5"; `window_named` makes the window of it again.
        coefficients: F₁, F₂ … of w(x) = 1 + 2 Σ Fₘ cos 2πm(x − ½), x from 0 to 1.
    """

    name: str
    coefficients: tuple[float, ...]

    def weights(self, position: Floats) -> Floats:
        """Return the window at positions 0 … 1 across the aperture; its mean is 1."""
        turn = 2 * np.pi * (np.asarray(position) - 0.5)
        weights = np.ones_like(turn)
        for order, factor in enumerate(self.coefficients, 1):
            weights += 2 * factor * np.cos(order * turn)
        return weights

    def point_response(self, place_cells: Floats | float) -> Floats:
        """Return the response's amplitude, 1 at its peak, `place_cells` Rayleigh cells from it."""
        place = np.asarray(place_cells, dtype=np.float64)
        response: Floats = np.sinc(place)
        for order, factor in enumerate(self.coefficients, 1):
            response = response + factor * (np.sinc(place - order) + np.sinc(place + order))
        return response

    @property
    def half_power_width_cells(self) -> float:
        """−3 dB width of the point response in Rayleigh cells."""
        return _shape(self)[0]

    @property
    def first_null_cells(self) -> float:
        """First null of the point response from its peak, in Rayleigh cells."""
        return _shape(self)[1]

    @property
    def highest_sidelobe_db(self) -> float:
        """Highest sidelobe of the point response below its peak, in decibels."""
        return _shape(self)[2]


HAMMING = Window(name="hamming", coefficients=(0.46 / 1.08,))
"""0.54 + 0.46 cos: −3 dB width 1.30 cells, highest sidelobe −43 dB (Harris, "On the use of windows
for harmonic analysis with the discrete Fourier transform", 1978, table 1)."""


def taylor(*, sidelobe_db: float = -35.0, nbar: int = 5) -> Window:
    """Return Taylor's window: the narrowest main lobe for a level of the near sidelobes.

    Args:
        sidelobe_db: level that the near sidelobes are held to, −80 to −20 dB.
        nbar: number of nulls that are moved; nbar − 1 near sidelobes are nearly equal.

    Raises:
        ValueError: a level or a number out of range.

    Source: Taylor, "Design of line-source antennas for narrow beamwidth and low side lobes", 1955;
    Carrara, Goodman and Majewski, "Spotlight synthetic aperture radar", 1995, appendix D.
    """
    lowest, highest = SIDELOBES_DB
    if not (lowest <= sidelobe_db <= highest and 2 <= nbar <= LARGEST_NBAR):
        raise ValueError(
            f"A Taylor window holds its sidelobes to {lowest:g} to {highest:g} dB with an nbar of "
            f"2 to {LARGEST_NBAR}; got {sidelobe_db:g} dB and {nbar}."
        )
    spread = np.arccosh(10 ** (-sidelobe_db / 20)) / np.pi
    dilation = nbar**2 / (spread**2 + (nbar - 0.5) ** 2)
    null = np.arange(1, nbar)
    moved = dilation * (spread**2 + (null - 0.5) ** 2)
    factors = []
    for order in null:
        others = null[null != order]
        above = np.prod(1 - order**2 / moved)
        below = 2 * np.prod(1 - order**2 / others**2)
        factors.append(float((-1) ** (order + 1) * above / below))
    return Window(name=f"taylor {sidelobe_db:g} dB nbar {nbar}", coefficients=tuple(factors))


def window_named(name: str) -> Window:
    """Return the window of a name such as "hamming" or "taylor -35 dB nbar 5".

    Raises:
        ValueError: a name of another form, or a Taylor window that does not exist.
    """
    if name == HAMMING.name:
        return HAMMING
    match = _TAYLOR.fullmatch(name)
    if match is None:
        raise ValueError(
            f'A window is called "hamming" or like "taylor -35 dB nbar 5"; got "{name[:40]}".'
        )
    return taylor(sidelobe_db=float(match[1]), nbar=int(match[2]))


@cache
def _shape(window: Window) -> tuple[float, float, float]:
    """Return −3 dB width and first null in cells, and the highest sidelobe in decibels."""
    place = np.linspace(0.0, LONGEST_RESPONSE_CELLS, 40001)
    response = window.point_response(place)
    after = int(np.argmax(response <= 0))
    null = brentq(window.point_response, place[after - 1], place[after] + 1e-9)
    half = brentq(lambda at: float(window.point_response(at)) - np.sqrt(0.5), 0.0, null)
    sidelobe = np.abs(response[place >= null]).max()
    return 2 * float(half), float(null), 20 * float(np.log10(sidelobe))
