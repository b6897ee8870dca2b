"""`radarhull measure`."""

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
import tyro

from app.commands.bodies import body_of_files
from app.commands.console import progress_bars, show_table
from app.commands.measure_output import facts, rows_table
from app.commands.observation import Observation, observed_satellite, utc_time
from app.commands.options import DEFAULT_CARVING, CarvingOptions, JsonTo, OptionalFile
from app.commands.outputs import STANDARD_OUTPUT, checked_json, write_json
from core.analysis.measured_body import DEFAULT_SPECS, Body, Orbit, Row, measured
from core.formats.files import checked_output
from core.formats.measurements import read_measurements, write_measurements
from core.geometry.directions import FrameName
from core.hull.casting import Watch
from core.measurement.intervals import COMMON_EDGE_CELLS
from core.measurement.results import Lost
from core.measurement.specs import Spec


@dataclass(frozen=True)
class InFrames:
    """In which frames directions are given."""

    tle: OptionalFile = None
    """File of the target's two-line element sets, for directions in RTN and TEME too."""
    tle_index: int = 0
    """Which set of the file, from 0."""
    at: Annotated[str | None, tyro.conf.arg(metavar="UTC", help_behavior_hint="")] = None
    """Time at which those directions hold, as 2016-03-11T15:00:00; the pass's first pulse unless
    given."""
    frame: FrameName = "target"
    """Frame of the directions that --csv and --json hold as readings; the table shows all."""


InFramesOptions = Annotated[InFrames, tyro.conf.arg(name="")]
DEFAULT_IN_FRAMES = InFrames()


def measure(
    files: Annotated[tuple[Path, ...], tyro.conf.Positional, tyro.conf.arg(metavar="PASS|HULL...")],
    /,
    *,
    spec: OptionalFile = None,
    csv: OptionalFile = None,
    json: JsonTo = None,
    intervals: bool = True,
    edge_cells: float = COMMON_EDGE_CELLS,
    in_frames: InFramesOptions = DEFAULT_IN_FRAMES,
    carving: CarvingOptions = DEFAULT_CARVING,
) -> None:
    """Measure lengths, attitude, volume and area of a hull: of passes, or of a mesh.

    Passes are carved first, as by "radarhull reconstruct", and every number has its 95 % interval
    and how well the views constrain it: what they do not observe is never given as a number. A
    mesh is measured as it is. What the hull does not allow (a part that vanished, a plane through
    three points in line, two equal points) says "lost: …" in its row, and the rest stands: the
    exit code is 0 all the same. Lengths are metres, areas m², volumes m³, angles degrees in the
    table and radians in files; ± marks a direction whose sign means nothing.

    Args:
        files: one or more pass files, which all vote together, or one mesh (.glb, .ply, .obj,
            .stl) in metres along the target frame's axes.
        spec: measurements to take (.json or .csv), as the workstation or this command writes
            them; extents, principal lines, box, volume and area unless given.
        csv: write the measurements here (.csv), to be read again by --spec.
        json: write the measurements as JSON to this file, or to standard output for "-"; to be
            read again by --spec.
        intervals: state a 95 % interval of every number, from some dozen further hulls.
        edge_cells: by how many pixels all outlines may be off together, with 95 % confidence.
        in_frames: in which frames directions are given.
        carving: how the hull is carved.
    """
    specs = DEFAULT_SPECS if spec is None else _specs(spec)
    settings = carving.settings()
    if csv is not None:
        checked_output(csv, (".csv",))
    checked_json(json)
    if not (np.isfinite(edge_cells) and edge_cells > 0):
        raise ValueError(f"--edge-cells wants a number of pixels above 0; got {edge_cells}.")
    _check_frames(in_frames)
    found = body_of_files(files, settings)
    body, orbit = found.body, _orbit(in_frames, found.epoch_utc)
    with_intervals = intervals and body.grid is not None
    rows = _measured(body, specs, orbit, with_intervals, edge_cells)
    for note in (*found.notes, *_lost_note(rows)):
        print(f"radarhull: note: {note}.", file=sys.stderr)
    entries = [row.entry(in_frames.frame) for row in rows]
    if csv is not None:
        write_measurements(csv, entries)
    if json is not None:
        write_json(json, facts(rows, entries, body, files, found.notes))
    if json != STANDARD_OUTPUT:
        show_table(rows_table(rows, body, orbit))


def _specs(path: Path) -> tuple[Spec, ...]:
    specs = tuple(entry.spec for entry in read_measurements(path))
    if not specs:
        raise ValueError(f"{path} holds no measurements; leave --spec out for the usual ones.")
    return specs


def _measured(
    body: Body, specs: Sequence[Spec], orbit: Orbit | None, with_intervals: bool, cells: float
) -> tuple[Row, ...]:
    with progress_bars() as report:
        watch = Watch(progress=lambda done, total: report("intervals", done, total))
        return measured(
            body, specs, orbit=orbit, with_intervals=with_intervals, cells=cells, watch=watch
        )


def _lost_note(rows: Sequence[Row]) -> tuple[str, ...]:
    lost = sum(isinstance(row.result, Lost) for row in rows)
    return (f"{lost} of {len(rows)} measurements are lost",) if lost else ()


def _check_frames(options: InFrames) -> None:
    if options.tle is None and (options.frame != "target" or options.at is not None):
        raise ValueError(
            "Directions in RTN and TEME need the target's orbit: give its elements as --tle FILE, "
            "or leave out --frame and --at."
        )


def _orbit(options: InFrames, epoch_utc: str) -> Orbit | None:
    if options.tle is None:
        return None
    satellite = observed_satellite(Observation(tle=options.tle, tle_index=options.tle_index))
    if not (options.at or epoch_utc):
        raise ValueError(
            "When directions hold in RTN and TEME is not known, as the file tells no time: give "
            "it as --at UTC."
        )
    return Orbit(satellite=satellite, at_utc=utc_time(options.at or epoch_utc))
