"""How much the measurement experiment looks at."""

from dataclasses import dataclass

from core.experiments.exact_features import KnownFeature, mro_features, tiangong_features
from core.radar.imaging import ImagingSettings
from core.radar.waveform import Waveform
from core.targets import Target, mro_like, tiangong_like

TARGETS = ("Tiangong-like", "MRO-like")


@dataclass(frozen=True, slots=True, kw_only=True)
class MeasurementSettings:
    """How much is simulated.

    Attributes:
        targets: names out of `TARGETS`.
        spacing_m: voxel spacing of all hulls but those of the coverage.
        exact_views: exact outlines of each target, from random directions over the sphere.
        exact_seeds: of those directions; the panels' row was once adjusted on seeds 1 and 2, the
            others were not looked at then.
        echo_views: coherent intervals of each target, from random directions over the sphere.
        scatterers: points on each target's surface.
        signal_to_noise_db: as in `simulate_echoes`.
        draws: of all outlines, for the coverage of the intervals.
        key_point_draws: of all marks, for each number of frames and each error of a mark.
        seed: of the random generator of all but the exact outlines.
    """

    targets: tuple[str, ...] = TARGETS
    spacing_m: float = 0.15
    exact_views: int = 240
    exact_seeds: tuple[int, ...] = (1, 3, 4, 5)
    echo_views: int = 80
    scatterers: int = 60_000
    signal_to_noise_db: float = 20.0
    draws: int = 200
    key_point_draws: int = 500
    seed: int = 1


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Case:
    """A target, what is measured on it, and a radar that sees all of it."""

    name: str
    target: Target
    features: tuple[KnownFeature, ...]
    waveform: Waveform
    imaging: ImagingSettings
    pulses_per_view: int


def case_named(name: str) -> Case:
    """Return the case of a target's name.

    Raises:
        ValueError: there is none.
    """
    if name not in TARGETS:
        raise ValueError(f'There is no target "{name}"; take {", ".join(TARGETS)}.')
    if name == TARGETS[0]:
        return Case(
            name=name,
            target=tiangong_like(),
            features=tiangong_features(),
            waveform=Waveform(),
            imaging=ImagingSettings(),
            pulses_per_view=256,
        )
    # Some 60 m across: twice the samples in frequency and in slow time, and larger images.
    return Case(
        name=name,
        target=mro_like(),
        features=mro_features(),
        waveform=Waveform(frequency_count=512),
        imaging=ImagingSettings(shape=(1100, 1100)),
        pulses_per_view=512,
    )
