"""Measured phase history in the form of AFRL's Gotcha volumetric SAR data set."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.io import loadmat

from core.arrays import Floats, frozen
from core.geometry.track import LineOfSightTrack
from core.radar.phase_history import PhaseHistory
from core.radar.waveform import SPEED_OF_LIGHT_M_PER_S

PULSE_INTERVAL_S = 1.0
"""Assumed: the files give no times. Doppler in hertz means nothing then; images do not change."""

RANGE_TOLERANCE_M = 0.01
"""How far r0 may be from the antenna's distance; single precision at 10 km leaves 0.001 m."""

GAP_STEPS = 3.0
"""More than so many median steps of azimuth between two pulses are a gap."""

Fields = Mapping[str, NDArray[Any]]


def read_gotcha(paths: Sequence[Path], *, autofocus: bool = False) -> PhaseHistory:
    """Read one or more files of neighbouring degrees of azimuth as one phase history.

    The target frame is the scene's own, in metres, and the radar stands at the antenna's position;
    R(0) is its distance from the scene's origin. The data set follows Gorham and Moore (2010):
    a point returns exp(−j 4π f (R(p) − R(0)) / c), which is ours, so that nothing is conjugated.
    Found by test, not on trust, because the conjugate focuses as well, to the picture turned by
    180 degrees. Only with this sign do the files' own autofocus phases undo their own autofocus
    ranges (49 dB peak over median; with the other sign 24 dB), and only then do the vehicles'
    multiple reflections, which come late, trail away from the radar.

    Args:
        paths: in any order; the pulses are sorted by azimuth.
        autofocus: apply the files' correction. It is made for whole circles: over the 4° of pass 1
            the picture is focused as well without (50 dB), and does not shift 0.3 m in range.

    Raises:
        ValueError: no files, a file that is no such data, or azimuths that leave a gap or overlap.

    Source: Casteel, Gorham, Minardi, Scarborough, Naidu and Majumder, "A challenge problem for
    2D/3D imaging of targets from a volumetric data set in an urban environment", 2007; Gorham and
    Moore, "SAR image formation toolbox for MATLAB", 2010.
    """
    if not paths:
        raise ValueError("Wanted at least one Gotcha file (data_3dsar_*.mat), got none.")
    files = [_fields(path, autofocus=autofocus) for path in paths]
    frequency_hz = _common_frequencies(files, paths)
    antenna_m = np.concatenate([fields["antenna_m"] for fields in files])
    samples = np.concatenate([fields["samples"] for fields in files])
    order = _azimuth_order(antenna_m)
    even_hz, even_samples = _evenly_spaced(frequency_hz, samples[order])
    return PhaseHistory(
        samples=even_samples,
        frequency_hz=even_hz,
        track=track_of_positions(antenna_m[order]),
        sensor="AFRL Gotcha",
    )


def track_of_positions(antenna_m: Floats) -> LineOfSightTrack:
    """Return the track of a radar that sends one pulse a second from positions (pulses, 3)."""
    if len(antenna_m) < 3:
        raise ValueError(f"Wanted at least 3 pulses, got {len(antenna_m)}.")
    range_m = np.linalg.norm(antenna_m, axis=1)
    line_of_sight = -antenna_m / range_m[:, None]
    time_s = np.arange(len(antenna_m), dtype=np.float64) * PULSE_INTERVAL_S
    rate = np.gradient(line_of_sight, time_s, axis=0, edge_order=2)
    rate -= line_of_sight * np.sum(line_of_sight * rate, axis=1, keepdims=True)
    return LineOfSightTrack(
        time_s=time_s,
        line_of_sight=line_of_sight,
        line_of_sight_rate_per_s=rate,
        range_m=range_m,
    )


def _fields(path: Path, *, autofocus: bool) -> Fields:
    """Return antenna_m (pulses, 3), samples (pulses, frequencies) and frequency_hz of a file."""
    data = _structure(path)
    try:
        frequency_hz = frozen(data.freq, np.float64, (None,), "freq")
        antenna_m = np.column_stack([np.atleast_1d(getattr(data, axis)) for axis in "xyz"])
        antenna_m = frozen(antenna_m, np.float64, (None, 3), "x, y, z")
        samples = frozen(
            np.transpose(data.fp), np.complex64, (len(antenna_m), len(frequency_hz)), "fp"
        )
        r0_m = frozen(data.r0, np.float64, (len(antenna_m),), "r0")
        if autofocus:
            samples = samples * _autofocus(data.af, frequency_hz, len(antenna_m))
    except (AttributeError, TypeError, ValueError) as error:
        raise ValueError(
            f"{path.name} is not in Gotcha's form (fields fp, freq, x, y, z, r0, af): {error}"
        ) from error
    off_m = float(np.abs(np.linalg.norm(antenna_m, axis=1) - r0_m).max(initial=0.0))
    if off_m > RANGE_TOLERANCE_M:
        raise ValueError(
            f"{path.name}: r0 must be the antenna's distance from the scene's origin, but differs "
            f"from that of x, y, z by up to {off_m:.3g} m. Are they of another file?"
        )
    return {"antenna_m": antenna_m, "samples": samples, "frequency_hz": frequency_hz}


def _structure(path: Path) -> Any:
    if not path.is_file():
        raise ValueError(f"Wanted a Gotcha file (data_3dsar_*.mat); {path} is no file.")
    try:
        contents = loadmat(path, squeeze_me=True, struct_as_record=False)
    except Exception as error:  # SciPy raises what its parser happens to meet
        raise ValueError(
            f"{path.name} is no MATLAB file of version 7.2 or older that SciPy can read: {error}"
        ) from error
    if "data" not in contents:
        found = ", ".join(name for name in contents if not name.startswith("__")) or "nothing"
        raise ValueError(f'{path.name} must hold a structure called "data", but holds {found}.')
    return contents["data"]


def _autofocus(correction: Any, frequency_hz: Floats, pulses: int) -> NDArray[np.complex64]:
    """Return the factor (pulses, frequencies) that turns by ph_correct and moves by r_correct."""
    range_m = frozen(correction.r_correct, np.float64, (pulses,), "af.r_correct")
    phase_rad = frozen(correction.ph_correct, np.float64, (pulses,), "af.ph_correct")
    wavenumber = 4 * np.pi / SPEED_OF_LIGHT_M_PER_S * frequency_hz
    factor: NDArray[np.complex64] = np.exp(
        1j * (phase_rad[:, None] - range_m[:, None] * wavenumber)
    ).astype(np.complex64)
    return factor


def _common_frequencies(files: Sequence[Fields], paths: Sequence[Path]) -> Floats:
    frequency_hz: Floats = files[0]["frequency_hz"]
    for fields, path in zip(files, paths, strict=True):
        if not np.array_equal(fields["frequency_hz"], frequency_hz):
            raise ValueError(
                f"{path.name} has other frequencies than {paths[0].name}; "
                "read files of one pass and polarisation together."
            )
    return frequency_hz


def _azimuth_order(antenna_m: Floats) -> NDArray[np.intp]:
    """Return the order of pulses by growing azimuth, beginning after the widest gap."""
    azimuth = np.arctan2(antenna_m[:, 1], antenna_m[:, 0])
    order = np.argsort(azimuth)
    to_next = np.diff(azimuth[order], append=azimuth[order[0]] + 2 * np.pi)
    order = np.roll(order, -int(np.argmax(to_next)) - 1)
    step = np.diff(np.unwrap(azimuth[order]))
    usual = float(np.median(step)) if len(step) else 0.0
    if len(step) and (step.max() > GAP_STEPS * usual or step.min() < usual / GAP_STEPS):
        at = int(np.argmax(np.abs(step - usual)))
        raise ValueError(
            f"The pulses must follow each other evenly in azimuth, {np.degrees(usual):.4f}° apart; "
            f"after {np.degrees(azimuth[order[at]]):.2f}° comes a step of "
            f"{np.degrees(step[at]):.4f}°. Give files of neighbouring degrees, each once."
        )
    return order


def _evenly_spaced(
    frequency_hz: Floats, samples: NDArray[np.complex64]
) -> tuple[Floats, NDArray[np.complex64]]:
    """Return samples (pulses, frequencies) at evenly spaced frequencies from first to last.

    The files hold frequencies in single precision, 1 kHz coarse: steps of 1.47 MHz that differ by
    so little stand for even ones. Others are interpolated by cubic splines, which costs 1 % at a
    third of the unambiguous range.
    """
    even = np.linspace(frequency_hz[0], frequency_hz[-1], len(frequency_hz))
    step = float(even[1] - even[0]) if len(even) > 1 else 0.0
    if not step > 0 or float(np.diff(frequency_hz).min()) <= 0:
        raise ValueError("The file's frequencies must grow.")
    if float(np.abs(frequency_hz - even).max()) < 1e-3 * step:
        return even, samples
    return even, CubicSpline(frequency_hz, samples, axis=1)(even).astype(np.complex64)
