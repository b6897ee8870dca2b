"""Who sees the target when: passes over Beijing, and one of them by three stations and a pair."""

from dataclasses import dataclass
from datetime import UTC, datetime

import numpy as np

from core.experiments.arcs import Arc, pair_arc, same_pass, station_arcs
from core.experiments.demo import DEMO_ORBIT, DEMO_STATION
from core.geometry.orbit import Station, satellite_from_elements
from core.radar.waveform import Waveform

START_UTC = datetime(2016, 3, 11, 15, tzinfo=UTC)

SHANGHAI = Station(latitude_deg=31.23, longitude_deg=121.47, height_m=4.0, name="Shanghai")
XIAN = Station(latitude_deg=34.27, longitude_deg=108.95, height_m=400.0, name="Xi'an")

SHARED = 3
"""The pass whose track runs between Beijing and Shanghai, seen by them and by Xi'an:
Beijing from the north, both others from the south."""

ALL_FRAMES = 3
"""Times as many frames of Beijing alone: as many as three stations have."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Network:
    """Arcs of one experiment: a station's passes, and one of them by several stations.

    Attributes:
        waveform: of all radars.
        beijing: passes over Beijing, in order.
        every: the shared pass over Beijing, with `ALL_FRAMES` times the frames.
        shanghai, xian: the shared pass over these.
        pair: Beijing sends, Shanghai receives.
    """

    waveform: Waveform
    beijing: tuple[Arc, ...]
    every: Arc
    shanghai: Arc
    xian: Arc
    pair: Arc

    def arcs(self) -> tuple[Arc, ...]:
        """Return all arcs, each once."""
        return (*self.beijing, self.every, self.shanghai, self.xian, self.pair)

    def together(self) -> dict[str, tuple[Arc, ...]]:
        """Return which arcs of the shared pass make which hull."""
        alone, pair = self.beijing[SHARED], self.pair
        shanghai, xian = self.shanghai, self.xian
        return {
            "Beijing": (alone,),
            f"Beijing, {ALL_FRAMES} times the frames": (self.every,),
            "Beijing and the pair": (alone, pair),
            "Beijing, Shanghai": (alone, shanghai),
            "Beijing, Shanghai, Xi'an": (alone, shanghai, xian),
            "all three and the pair": (alone, shanghai, xian, pair),
        }

    def sky(self) -> dict[str, tuple[Arc, ...]]:
        """Return the arcs that a sky plot shows together, by its title."""
        shared = (self.every, self.shanghai, self.xian, self.pair)
        return {
            "passes over Beijing": self.beijing,
            f"the pass {self.beijing[SHARED].label}": shared,
        }

    def bistatic_deg(self) -> tuple[float, float]:
        """Return the least and the greatest bistatic angle of the pair's images."""
        scale = self.pair.track.bisector_scale
        if scale is None:  # a pair's track has it
            raise ValueError("The track is no pair's, so it has no bistatic angle.")
        middles = [each.middle for each in self.pair.intervals]
        angles = np.rad2deg(2 * np.arccos(scale[middles]))
        return float(angles.min()), float(angles.max())

    def settings(self) -> dict[str, object]:
        """Return what a report says of orbit, stations and passes."""
        return {
            "orbit": f"{DEMO_ORBIT.name}, elements of {DEMO_ORBIT.epoch_utc:%Y-%m-%d %H:%M} UTC",
            "stations": "; ".join(map(_station_text, (DEMO_STATION, SHANGHAI, XIAN))),
            "passes over Beijing": [arc.label for arc in self.beijing],
            "shared pass": self.beijing[SHARED].label,
        }


def observing_network(passes: int, frames: int) -> Network:
    """Return the arcs of so many passes, each of so many frames.

    Raises:
        ValueError: fewer passes than the shared one needs, or no frames.
    """
    if passes <= SHARED or frames < 1:
        raise ValueError(
            f"The stations share pass {SHARED + 1}, so that as many are needed, with a frame each; "
            f"got {passes} of {frames}."
        )
    waveform, satellite = Waveform(), satellite_from_elements(DEMO_ORBIT)
    beijing = station_arcs(
        satellite, DEMO_STATION, waveform, start_utc=START_UTC, count=passes, frames=frames
    )
    shared = beijing[SHARED]
    shanghai, xian = (
        same_pass(satellite, station, shared, waveform, frames=frames)
        for station in (SHANGHAI, XIAN)
    )
    return Network(
        waveform=waveform,
        beijing=beijing,
        every=same_pass(satellite, DEMO_STATION, shared, waveform, frames=ALL_FRAMES * frames),
        shanghai=shanghai,
        xian=xian,
        pair=pair_arc(
            satellite, DEMO_STATION, SHANGHAI, (shared, shanghai), waveform, frames=frames
        ),
    )


def _station_text(station: Station) -> str:
    return f"{station.name} {station.latitude_deg:g}° N, {station.longitude_deg:g}° E"
