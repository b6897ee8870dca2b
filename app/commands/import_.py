"""`radarhull import`."""

from pathlib import Path
from typing import Annotated

import tyro

from app.commands.options import JsonTo
from app.commands.outputs import checked_json, checked_pass, echo_facts, show_summary
from core.formats.gotcha import read_gotcha
from core.formats.pass_file import RecordedPass, write_pass


def import_(
    files: Annotated[tuple[Path, ...], tyro.conf.Positional, tyro.conf.arg(metavar="FILE...")],
    /,
    *,
    out: Annotated[Path, tyro.conf.arg(metavar="OUT")],
    autofocus: bool = False,
    json: JsonTo = None,
) -> None:
    """Turn measured phase histories into a pass file.

    Read today: the AFRL Gotcha volumetric SAR data set (data_3dsar_*.mat, MATLAB v5), one or
    more files of neighbouring degrees of azimuth.

    Args:
        files: MATLAB files of one pass and polarisation.
        out: pass file to write (.h5).
        autofocus: apply the phase correction that the files bring along.
        json: write a summary as JSON to this file, or to standard output for "-".
    """
    checked_pass(out)
    checked_json(json)
    history = read_gotcha(files, autofocus=autofocus)
    write_pass(out, RecordedPass(history=history))
    band_mhz = history.bandwidth_hz / 1e6
    show_summary(
        f"{out}: {len(history.track)} pulses × {len(history.frequency_hz)} frequencies, "
        f"{band_mhz:.0f} MHz about {history.frequency_hz.mean() / 1e9:.3f} GHz.",
        {"file": str(out), "sources": [path.name for path in files], **echo_facts(history)},
        json,
    )
