"""`radarhull bench`."""

import importlib
import importlib.util
import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated, Literal

import tyro

from app import loop_benchmark as loop
from app import pick_benchmark as picking
from app.commands.console import Report, progress_bars
from app.commands.options import JsonTo, OptionalInt, checked_seed
from app.commands.outputs import checked_json, show_results
from core.benchmarks import carve, edit, growth
from core.benchmarks.image import run_image
from core.benchmarks.plots import plot_growth
from core.experiments.results import Results

Benchmark = Literal["carve", "edit", "growth", "surface", "image", "loop", "picks"]
Sizes = Sequence[tuple[int, int]]


def bench(
    name: Annotated[
        Literal["carve", "edit", "growth", "surface", "image", "loop", "picks"],
        tyro.conf.Positional,
    ],
    /,
    *,
    sizes: Annotated[tuple[str, ...], tyro.conf.arg(metavar="NxVIEWS", help_behavior_hint="")] = (),
    repeats: OptionalInt = None,
    json: JsonTo = None,
    out: Annotated[Path | None, tyro.conf.arg(metavar="FOLDER", help_behavior_hint="")] = None,
    seed: int = 1,
) -> None:
    """Measure the carving engine on a test satellite with exact outlines, or imaging on the demo.

    carve: all votes, against every peer that is installed and against the exact votes. edit: from
    a dragged vertex or a new outline to the exact mesh. growth: time and memory against voxels,
    views and vertices, with stored votes and hull only. surface: error against the true hull.
    image: from the demo's echoes to its 60 frames, against back-projection and plain NumPy. loop:
    from a committed outline to the hull at a client of the running workstation's viewport. picks:
    from a click's ray to the anchor that it means. Peers come with the extra "bench".

    Args:
        name: what to measure.
        sizes: voxels a side and views, as 256x60; the benchmark's own by default.
        repeats: runs (carve, growth, image), edits (edit, loop) or picks of each kind; the
            benchmark's own by default.
        json: write settings and figures as JSON to this file, or to standard output for "-".
        out: folder for plots (growth).
        seed: of views, edits and echoes.
    """
    if repeats is not None and repeats < 1:
        raise ValueError(f"At least 1 repeat is needed, got {repeats}.")
    if out is not None and name != "growth":
        raise ValueError(f"Only growth draws plots; leave --out away for {name}.")
    if sizes and name == "image":
        raise ValueError("The demo's frames have their own size; leave --sizes away for image.")
    checked_json(json)
    checked_seed(seed)
    chosen = tuple(_size(text) for text in sizes)
    with progress_bars() as report:
        results = _run(name, chosen, repeats, out, seed, report)
    show_results(results, json)


def _run(
    name: Benchmark, sizes: Sizes, repeats: int | None, out: Path | None, seed: int, report: Report
) -> Results:
    runs: dict[Benchmark, Callable[[], Results]] = {
        "carve": lambda: carve.run_carve(
            sizes=sizes or carve.SIZES, repeats=repeats or 5, seed=seed, progress=report
        ),
        "edit": lambda: edit.run_edit(
            sizes=sizes or edit.SIZES, repeats=repeats or 100, seed=seed, progress=report
        ),
        "image": lambda: run_image(repeats=repeats or 3, seed=seed, progress=report),
        "loop": lambda: loop.run_loop(
            sizes=sizes or loop.SIZES, edits=repeats or loop.EDITS, seed=seed, progress=report
        ),
        "picks": lambda: picking.run_picks(
            sizes=sizes or picking.SIZES, picks=repeats or picking.PICKS, seed=seed, progress=report
        ),
        "surface": lambda: _surface(sizes, seed, report),
        "growth": lambda: _growth(sizes, repeats or 5, out, seed, report),
    }
    return runs[name]()


def _growth(sizes: Sizes, repeats: int, out: Path | None, seed: int, report: Report) -> Results:
    results, curves = growth.run_growth(
        sizes=sizes or growth.SIZES, repeats=repeats, seed=seed, progress=report
    )
    if out is not None:
        plot_growth(curves, out / "growth.png")
    return results


def _surface(sizes: Sizes, seed: int, report: Report) -> Results:
    _require("manifold3d", "The true hull")
    surface = importlib.import_module("core.benchmarks.surface")
    results: Results = surface.run_surface(sizes=sizes or surface.SIZES, seed=seed, progress=report)
    return results


def _require(package: str, what: str) -> None:
    if importlib.util.find_spec(package) is None:
        raise ValueError(
            f'{what} needs {package}; install it with: pip install "radarhull[bench]".'
        )


def _size(text: str) -> tuple[int, int]:
    match = re.fullmatch(r"(\d+)[x×](\d+)", text)
    if match is None or int(match[1]) < 8 or int(match[2]) < 2:
        raise ValueError(
            f'A size reads like 256x60, at least 8 voxels a side and 2 views; got "{text}".'
        )
    return int(match[1]), int(match[2])
