"""`radarhull import`."""

from pathlib import Path
from typing import Annotated

import tyro

from core.formats.gotcha import read_gotcha
from core.formats.pass_file import RecordedPass, write_pass


def import_(
    files: Annotated[tuple[Path, ...], tyro.conf.Positional],
    /,
    *,
    out: Path,
    autofocus: bool = False,
) -> None:
    """Turn measured phase histories into a pass file.

    Read today: the AFRL Gotcha volumetric SAR data set (data_3dsar_*.mat, MATLAB v5), one or
    more files of neighbouring degrees of azimuth.

    Args:
        files: MATLAB files of one pass and polarisation.
        out: pass file to write (.h5).
        autofocus: apply the phase correction that the files bring along.
    """
    history = read_gotcha(files, autofocus=autofocus)
    write_pass(out, RecordedPass(history=history))
    band_mhz = history.bandwidth_hz / 1e6
    print(
        f"{out}: {len(history.track)} pulses × {len(history.frequency_hz)} frequencies, "
        f"{band_mhz:.0f} MHz about {history.frequency_hz.mean() / 1e9:.3f} GHz."
    )
