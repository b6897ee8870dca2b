"""`radarhull serve`."""

from pathlib import Path
from typing import Annotated

import tyro

from app.server import DEFAULT_PORT
from app.server import serve as serve_source
from app.source import Source
from core.experiments.demo import DEMO_PASSES, FRAMES_PER_PASS, demo_frames
from core.formats.pass_file import read_pass
from core.radar.imaging import frame_count, frames
from core.reconstruction import ReconstructionSettings


def serve(
    pass_file: Annotated[Path | None, tyro.conf.Positional] = None,
    /,
    *,
    port: int = DEFAULT_PORT,
    open: bool = False,  # noqa: A002 - the flag's name on the command line
    spacing_m: float = 0.15,
    side_m: float = 21.0,
) -> None:
    """Serve the workstation on one page of this machine.

    Args:
        pass_file: a pass file to play; without one, the built-in demo of three simulated passes.
        port: port on 127.0.0.1; 0 takes any free one.
        open: also open the page in the browser.
        spacing_m: voxel spacing in metres.
        side_m: side of the cubic grid in metres.
    """
    source = demo_source() if pass_file is None else pass_source(pass_file)
    serve_source(
        source,
        port=port,
        open_browser=open,
        settings=ReconstructionSettings(spacing_m=spacing_m, side_m=side_m),
    )


def demo_source() -> Source:
    """Return the built-in demo."""
    return Source(
        name="Demo: Tiangong-1-like, three passes over Beijing",
        description="Echoes simulated at 16.7 GHz, 1 GHz bandwidth, 100 pulses per second.",
        frames=demo_frames,
        expected_frames=FRAMES_PER_PASS * len(DEMO_PASSES),
    )


def pass_source(path: Path) -> Source:
    """Return a pass file's frames, or the images of its echoes where it holds no frames.

    Raises:
        ValueError: no readable pass file, or fewer than two frames.
    """
    recorded = read_pass(path)
    if recorded.frames:
        if len(recorded.frames) < 2:
            raise ValueError(f"{path} holds 1 frame; a hull needs at least 2 views.")
        return Source(
            name=path.name, frames=lambda: recorded.frames, expected_frames=len(recorded.frames)
        )
    history = recorded.history
    assert history is not None
    return Source(
        name=path.name,
        frames=lambda: frames(history),
        expected_frames=frame_count(history),
    )
