"""The pass file: what came from the sensors, in HDF5, never changed by an analyst's work.

Layout, schema version 1 (every dataset carries its unit in the attribute `unit`):

    /                     attributes format = "radarhull pass", schema_version, sensor
    /history/samples      (pulses, frequencies) complex64
    /history/frequency_hz (frequencies,)
    /track/time_s …       the fields of `LineOfSightTrack`, attribute epoch_utc
    /frames/000000/…      amplitude (rows, columns), matrix (2 or 3, 4), line_of_sight (3,),
                          sun_direction (3,) where the sun lights it;
                          attributes time_s, sensor, label, window, spacings and resolutions

A pass file may come from anywhere, so it is read as untrusted: `core.formats.untrusted_hdf5`.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py

from core.formats.files import written_aside
from core.formats.untrusted_hdf5 import opened, read_array, read_attribute, read_group
from core.frame import LENGTHS, Frame
from core.geometry.projection import Projection
from core.geometry.track import LineOfSightTrack
from core.radar.phase_history import PhaseHistory
from core.radar.window import HAMMING, window_named

FORMAT = "radarhull pass"
SCHEMA_VERSION = 1

_TRACK_REQUIRED = {"time_s": "s", "line_of_sight": "1", "line_of_sight_rate_per_s": "1/s"}
_TRACK_OPTIONAL = {
    "range_m": "m",
    "azimuth_rad": "rad",
    "elevation_rad": "rad",
    "bisector_scale": "1",
}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RecordedPass:
    """What a pass file holds.

    Attributes:
        history: echoes with their track, None if only images were recorded.
        frames: images, empty if only echoes were recorded.
    """

    history: PhaseHistory | None = None
    frames: tuple[Frame, ...] = ()

    def __post_init__(self) -> None:
        if self.history is None and not self.frames:
            raise ValueError("A pass holds echoes, frames or both; this one holds neither.")


def write_pass(path: Path, recorded: RecordedPass) -> None:
    """Write a pass file; an existing file is replaced only once the new one is whole.

    Raises:
        ValueError: the folder does not exist or cannot be written.
    """
    with written_aside(path) as aside, h5py.File(aside, "w", track_order=True) as file:
        _write_content(file, recorded)


def read_pass(path: Path) -> RecordedPass:
    """Read and check a pass file.

    Raises:
        ValueError: no such file, not a whole HDF5 file, not a pass file, of a newer schema, with
            links or storage outside itself, too large, or with values a field refuses.
    """
    with opened(path) as file:
        kind = read_attribute(file, "format", str, default="")
        if kind != FORMAT:
            raise ValueError(
                f'{path} is an HDF5 file, but not a pass file: its attribute "format" is '
                f'"{kind}", wanted "{FORMAT}". Use radarhull import for other formats.'
            )
        version = read_attribute(file, "schema_version", int)
        if version > SCHEMA_VERSION:
            raise ValueError(
                f"{path} has schema version {version}; this radarhull reads up to "
                f"{SCHEMA_VERSION}. Update radarhull."
            )
        try:
            return RecordedPass(history=_read_history(file), frames=tuple(_read_frames(file)))
        except ValueError as error:
            raise ValueError(f"{path}: {error}") from error


def _write_content(file: h5py.File, recorded: RecordedPass) -> None:
    file.attrs["format"] = FORMAT
    file.attrs["schema_version"] = SCHEMA_VERSION
    if recorded.history is not None:
        _write_history(file, recorded.history)
    for number, frame in enumerate(recorded.frames):
        _write_frame(file.create_group(f"frames/{number:06d}"), frame)


def _write_array(group: h5py.Group, name: str, values: Any, unit: str, **storage: Any) -> None:
    group.create_dataset(name, data=values, **storage).attrs["unit"] = unit


def _write_history(file: h5py.File, history: PhaseHistory) -> None:
    group = file.create_group("history")
    group.attrs["sensor"] = history.sensor
    _write_array(group, "samples", history.samples, "1")
    _write_array(group, "frequency_hz", history.frequency_hz, "Hz")
    track = file.create_group("track")
    track.attrs["epoch_utc"] = history.track.epoch_utc
    for name, unit in {**_TRACK_REQUIRED, **_TRACK_OPTIONAL}.items():
        values = getattr(history.track, name)
        if values is not None:
            _write_array(track, name, values, unit)


def _read_history(file: h5py.File) -> PhaseHistory | None:
    if "history" not in file:
        return None
    if "track" not in file:
        raise ValueError("the file holds echoes, but no track with their lines of sight.")
    group = read_group(file, "track")
    fields = {name: read_array(group, name, unit) for name, unit in _TRACK_REQUIRED.items()}
    known = {
        name: read_array(group, name, unit)
        for name, unit in _TRACK_OPTIONAL.items()
        if name in group
    }
    track = LineOfSightTrack(
        time_s=fields["time_s"],
        line_of_sight=fields["line_of_sight"],
        line_of_sight_rate_per_s=fields["line_of_sight_rate_per_s"],
        epoch_utc=read_attribute(group, "epoch_utc", str, default=""),
        **known,
    )
    echoes = read_group(file, "history")
    return PhaseHistory(
        samples=read_array(echoes, "samples", "1", complex_values=True),
        frequency_hz=read_array(echoes, "frequency_hz", "Hz"),
        track=track,
        sensor=read_attribute(echoes, "sensor", str, default="radar"),
    )


def _write_frame(group: h5py.Group, frame: Frame) -> None:
    packed = {"compression": "gzip", "compression_opts": 1, "shuffle": True}
    _write_array(group, "amplitude", frame.amplitude, "1", **packed)
    _write_array(group, "matrix", frame.projection.matrix, "pixel/m")
    _write_array(group, "line_of_sight", frame.line_of_sight, "1")
    if frame.sun_direction is not None:
        _write_array(group, "sun_direction", frame.sun_direction, "1")
    group.attrs["time_s"] = frame.time_s
    group.attrs["sensor"] = frame.sensor
    group.attrs["label"] = frame.label
    group.attrs["window"] = frame.window
    for name in LENGTHS:
        value = getattr(frame, name)
        if value is not None:
            group.attrs[name] = value


def _read_frames(file: h5py.File) -> Iterable[Frame]:
    if "frames" not in file:
        return
    every = read_group(file, "frames")
    for name in sorted(every):
        group = read_group(every, name)
        lengths = {key: read_attribute(group, key, float, default=None) for key in LENGTHS}
        sensor = read_attribute(group, "sensor", str)
        if sensor not in ("radar", "optical"):
            raise ValueError(f'frame {name} comes from a "{sensor}"; "radar" or "optical" wanted.')
        yield Frame(
            amplitude=read_array(group, "amplitude", "1"),
            projection=Projection(matrix=read_array(group, "matrix", "pixel/m")),
            line_of_sight=read_array(group, "line_of_sight", "1"),
            time_s=read_attribute(group, "time_s", float),
            sensor=sensor,
            label=read_attribute(group, "label", str, default=""),
            window=window_named(read_attribute(group, "window", str, default=HAMMING.name)).name,
            sun_direction=(
                read_array(group, "sun_direction", "1") if "sun_direction" in group else None
            ),
            **lengths,
        )
