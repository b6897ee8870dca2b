"""`radarhull simulate`."""

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
import tyro

from app.commands.console import progress_bars
from app.commands.echo_options import DEFAULT_ERRORS, DEFAULT_SURFACE, Errors, Surface
from app.commands.observation import (
    DEFAULT_OBSERVATION,
    Observation,
    observed_satellite,
    pass_track,
)
from app.commands.options import (
    Gigahertz,
    JsonTo,
    OptionalFile,
    OutputFile,
    checked_seed,
    checked_snr_db,
)
from app.commands.outputs import checked_json, checked_pass, echo_facts, show_summary
from core.formats.meshes import read_mesh
from core.formats.pass_file import RecordedPass, write_pass
from core.frame import Frame
from core.geometry.track import LineOfSightTrack
from core.optical.simulation import simulate_optical_frames
from core.optical.sun import track_illumination
from core.radar.echoes import ScatteringModel, simulate_echoes
from core.radar.phase_history import PhaseHistory
from core.radar.pulse_errors import with_pulse_errors
from core.radar.waveform import Waveform
from core.targets import Target, tiangong_like

MOST_OPTICAL_FRAMES = 1000


@dataclass(frozen=True)
class Radar:
    """What the radar sends."""

    carrier_hz: Gigahertz = 16.7e9
    """Centre frequency, hertz."""
    bandwidth_hz: Gigahertz = 1.0e9
    """Bandwidth, hertz."""
    frequency_count: int = 256
    """Frequency samples across the band; more of them tell a larger target apart in range."""
    prf_hz: float = 100.0
    """Pulses per second."""
    snr_db: float = 20.0
    """Mean echo power over noise power, per pulse and frequency sample, decibels."""

    def waveform(self) -> Waveform:
        """Return what these options mean.

        Raises:
            ValueError: a frequency that is not positive, or too few samples.
        """
        return Waveform(
            carrier_frequency_hz=self.carrier_hz,
            bandwidth_hz=self.bandwidth_hz,
            pulse_repetition_frequency_hz=self.prf_hz,
            frequency_count=self.frequency_count,
        )


def simulate(
    out: OutputFile,
    /,
    *,
    mesh: OptionalFile = None,
    mesh_unit_m: float = 1.0,
    observation: Annotated[Observation, tyro.conf.arg(name="")] = DEFAULT_OBSERVATION,
    radar: Annotated[Radar, tyro.conf.arg(name="")] = Radar(),
    surface: Annotated[Surface, tyro.conf.arg(name="")] = DEFAULT_SURFACE,
    errors: Annotated[Errors, tyro.conf.arg(name="")] = DEFAULT_ERRORS,
    optical: int = 0,
    seed: int = 1,
    json: JsonTo = None,
) -> None:
    """Simulate the echoes of one pass of a self-shadowing target and write a pass file.

    Args:
        out: pass file to write (.h5).
        mesh: target as GLB, PLY, OBJ or STL; without one, a Tiangong-1-like laboratory.
        mesh_unit_m: metres per unit of the mesh file.
        observation: which pass of which orbit over which station.
        radar: what the radar sends.
        surface: how the target's surface scatters.
        errors: what goes wrong from pulse to pulse.
        optical: telescope frames beside the radar's echoes, evenly over the pass; the sun must
            light the target then, as in the pass from 2016-03-24T10:56 on.
        seed: of the random generator.
        json: write a summary as JSON to this file, or to standard output for "-".
    """
    checked_pass(out)
    checked_json(json)
    checked_snr_db(radar.snr_db)
    checked_seed(seed)
    disturbance = errors.pulse_errors()
    random = np.random.default_rng(seed)
    target = tiangong_like() if mesh is None else _mesh_target(mesh, mesh_unit_m)
    scattering = surface.scattering(target, random)
    track = pass_track(observation, radar.waveform())
    received = _echoes(scattering, track, radar, random)
    # Errors are drawn last, so that the same seed gives the same echoes with and without them.
    history, _ = with_pulse_errors(received, disturbance, random)
    photographs = _photographs(target, track, observation, optical, random)
    write_pass(out, RecordedPass(history=history, frames=photographs))
    seen = f" and {len(photographs)} telescope frames" if photographs else ""
    show_summary(
        f"{out}: {len(track)} pulses{seen} of {target.name} from {track.epoch_utc} on.",
        {
            "file": str(out),
            "target": target.name,
            "seed": seed,
            "optical_frames": len(photographs),
            **asdict(surface),
            **asdict(errors),
            **echo_facts(history),
        },
        json,
    )


def _echoes(
    scattering: ScatteringModel,
    track: LineOfSightTrack,
    radar: Radar,
    random: np.random.Generator,
) -> PhaseHistory:
    with progress_bars() as report:
        return simulate_echoes(
            scattering,
            track,
            radar.waveform(),
            signal_to_noise_db=radar.snr_db,
            random=random,
            progress=lambda done, total: report("pulses", done, total),
        )


def _mesh_target(path: Path, unit_m: float) -> Target:
    return Target(name=path.stem, parts=(read_mesh(path, unit_m=unit_m),))


def _photographs(
    target: Target,
    track: LineOfSightTrack,
    observation: Observation,
    count: int,
    random: np.random.Generator,
) -> tuple[Frame, ...]:
    """Return telescope frames at the middles of `count` equal parts of a pass."""
    if count == 0:
        return ()
    if not 0 < count <= MOST_OPTICAL_FRAMES:
        raise ValueError(f"--optical takes 0 to {MOST_OPTICAL_FRAMES} frames, got {count}.")
    middles = (np.arange(count) + 0.5) / count
    moments_s = track.time_s[0] + middles * (track.time_s[-1] - track.time_s[0])
    light = track_illumination(observed_satellite(observation), track, moments_s)
    with progress_bars() as report:
        return simulate_optical_frames(
            target,
            track,
            moments_s.tolist(),
            light,
            random=random,
            progress=lambda done, total: report("telescope frames", done, total),
        )
