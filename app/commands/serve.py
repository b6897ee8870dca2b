"""`radarhull serve`."""

from pathlib import Path
from typing import Annotated

import tyro

from app.commands.options import Carving, CarvingOptions, OptionalFile
from app.reference import Reference, reference_of
from app.server import DEFAULT_PORT
from app.server import serve as serve_source
from app.source import NO_SOURCE, Source
from app.sources import demo_source, pass_sources
from core.formats.meshes import read_mesh

Attitude = Annotated[tuple[float, float, float, float], tyro.conf.arg(metavar="W X Y Z")]
Offset = Annotated[tuple[float, float, float], tyro.conf.arg(metavar="X Y Z")]

WORKSTATION_CARVING = Carving(spacing_m=0.2)
"""Coarser than the other commands: the hull is meshed anew with every frame that arrives."""


def serve(
    pass_file: Annotated[
        Path | None,
        tyro.conf.Positional,
        tyro.conf.arg(metavar="[PASS]", help_behavior_hint=""),
    ] = None,
    /,
    *,
    port: int = DEFAULT_PORT,
    empty: bool = False,
    open: bool = False,  # noqa: A002 - the flag's name on the command line
    reference: OptionalFile = None,
    reference_attitude: Attitude = (1.0, 0.0, 0.0, 0.0),
    reference_offset: Offset = (0.0, 0.0, 0.0),
    carving: CarvingOptions = WORKSTATION_CARVING,
) -> None:
    """Serve the workstation on one page of this machine.

    Args:
        pass_file: a pass file to play; without one, the built-in demo of three simulated passes.
        port: port on 127.0.0.1; 0 takes any free one.
        empty: begin without a source; the page loads the demo or a pass file that is dropped on it.
        open: also open the page in the browser.
        reference: a mesh (GLB, PLY, OBJ, STL) in metres, to see and to compare the hull with.
        reference_attitude: quaternion w x y z that turns the mesh's axes to the target frame's.
        reference_offset: x y z in metres by which it is then moved.
        carving: how the hull is carved.
    """
    settings = carving.settings()
    if settings.registration == "agreement":
        raise ValueError(
            "Registration by agreement waits for all frames, and the workstation shows each as it "
            "comes; use radarhull reconstruct --register agreement, or --register centroid here."
        )
    if empty and pass_file is not None:
        raise ValueError(f"--empty begins without a source, and {pass_file} is one; leave one out.")
    serve_source(
        NO_SOURCE if empty else _source(pass_file),
        port=port,
        open_browser=open,
        settings=settings,
        reference=_reference(reference, reference_attitude, reference_offset),
    )


def _reference(
    file: Path | None,
    attitude: tuple[float, float, float, float],
    offset: tuple[float, float, float],
) -> Reference | None:
    return None if file is None else reference_of(read_mesh(file), attitude, offset)


def _source(pass_file: Path | None) -> Source:
    return demo_source() if pass_file is None else pass_sources([pass_file])[0]
