"""`radarhull bench edit`: from an analyst's edit to the exact mesh."""

import importlib
import importlib.util
from collections.abc import Callable, Iterator, Sequence
from itertools import islice
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from core.benchmarks.edits import drags, redrawn
from core.benchmarks.measuring import Progress, machine, measured, median_s, percentile
from core.benchmarks.workload import Task, satellite_task
from core.experiments.results import Figure, Results
from core.hull.surface import hull_surface
from core.hull.view import View
from core.hull.volume import VoteVolume

SIZES = ((256, 60), (512, 120))
EQUALITY_GRID = 48
EQUALITY_VIEWS = 20
CHECK_EVERY = 50
WANTED_MS = {
    ("drag", 256, 60): "<= 25 ms",
    ("outline", 256, 60): "<= 75 ms",
    ("drag", 512, 120): "<= 100 ms",
}

Edits = Iterator[tuple[int, View]]


class Editor(Protocol):
    """Something that takes an edited view and gives a surface."""

    def replace(self, number: int, view: View) -> None:
        """Let a view vote with another outline."""

    def surface(self) -> object:
        """Return the mesh as it now is."""


class Engine:
    """The engine as an application uses it."""

    def __init__(self, task: Task) -> None:
        """Let all views vote."""
        self.volume = VoteVolume(task.grid)
        self._numbers = self.volume.add_many(task.views)

    def replace(self, number: int, view: View) -> None:
        """Let a view vote with another outline."""
        self.volume.replace(self._numbers[number], view)

    def surface(self) -> object:
        """Return the exact mesh as it now is."""
        return self.volume.surface()


def run_edit(
    *,
    sizes: Sequence[tuple[int, int]] = SIZES,
    repeats: int = 100,
    equality_edits: int = 1000,
    seed: int = 1,
    progress: Progress = lambda _stage, _done, _total: None,
) -> Results:
    """Time drags of one vertex and whole new outlines, each until the mesh is there.

    Args:
        sizes: (voxels a side, views).
        repeats: edits of each kind.
        equality_edits: random edits after which votes and surface are held against from scratch.
        seed: of views and edits.
        progress: told of stage, steps done and steps in all.
    """
    before = machine()
    figures: list[Figure] = []
    for size, views in sizes:
        task = satellite_task(size, views, seed=seed)
        for kind, edits in (("drag", drags), ("outline", redrawn)):
            title = f"{size}³×{views}: {kind}"
            random = np.random.default_rng(seed)
            script = list(islice(edits(task.views, random), repeats + 1))
            times = _times(task, script, title, progress)
            figures += _figures(title, times, WANTED_MS.get((kind, size, views)))
    figures += equality_figures(equality_edits, seed=seed, progress=progress)
    settings = {
        "sizes": [f"{size}x{views}" for size, views in sizes],
        "repeats": repeats,
        "equality": f"{equality_edits} edits on {EQUALITY_GRID}³×{EQUALITY_VIEWS}",
        "seed": seed,
        **before,
        "load_average_at_end": machine()["load_average"],
        "rival": "OpenCV deltas + VTK flying edges, both kept to what changed"
        if rival_is_installed()
        else "not installed (VTK)",
    }
    return Results(name="edit", settings=settings, figures=tuple(figures))


def rival_is_installed() -> bool:
    """Return whether VTK, the fastest mesher found, is there."""
    return importlib.util.find_spec("vtkmodules") is not None


def _times(
    task: Task, script: list[tuple[int, View]], title: str, progress: Progress
) -> dict[str, list[float]]:
    """Return the seconds of every edit by every editor, taking turns."""
    editors: dict[str, Editor] = {"radarhull": Engine(task)}
    if rival_is_installed():
        editors["OpenCV + VTK"] = importlib.import_module("core.benchmarks.rival").Rival(task)
    first, *rest = script
    for editor in editors.values():
        editor.surface()
        _edit(editor, *first)()  # compiles
    times: dict[str, list[float]] = {name: [] for name in editors}
    for done, (number, view) in enumerate(rest, start=1):
        for name, editor in editors.items():
            times[name].append(measured(_edit(editor, number, view)).seconds)
        progress(title, done, len(rest))
    return times


def _edit(editor: Editor, number: int, view: View) -> Callable[[], None]:
    def work() -> None:
        editor.replace(number, view)
        editor.surface()

    return work


def _figures(title: str, times: dict[str, list[float]], wanted: str | None) -> list[Figure]:
    figures = []
    for name, seconds in times.items():
        figures += [
            Figure(name=f"{title}, {name}, median", value=1e3 * median_s(seconds), unit="ms"),
            Figure(
                name=f"{title}, {name}, p95",
                value=1e3 * percentile(seconds, 95),
                unit="ms",
                wanted=wanted if name == "radarhull" else None,
            ),
        ]
    if "OpenCV + VTK" in times:
        ratio = median_s(times["OpenCV + VTK"]) / median_s(times["radarhull"])
        figures.append(
            Figure(name=f"{title}, times faster than OpenCV + VTK", value=ratio, wanted=">= 2")
        )
    return figures


def equality_figures(
    edits: int,
    *,
    size: int = EQUALITY_GRID,
    views: int = EQUALITY_VIEWS,
    seed: int = 1,
    progress: Progress = lambda _stage, _done, _total: None,
) -> list[Figure]:
    """Return by how many voxels and vertices incremental differs from scratch, after many edits.

    Edits are drags, new outlines, exclusions and inclusions, and threshold changes, at random.
    """
    random = np.random.default_rng(seed)
    task = satellite_task(size, views, seed=seed)
    volume = VoteVolume(task.grid)
    numbers = volume.add_many(task.views)
    scripts = drags(task.views, random), redrawn(task.views, random)
    voxels = vertices = 0
    for done in range(1, edits + 1):
        _random_edit(volume, numbers, scripts, random)
        surface = volume.surface()
        if done % CHECK_EVERY == 0 or done == edits:
            fresh = _from_scratch(volume)
            voxels += int(np.count_nonzero(fresh.votes != volume.votes))
            expected = hull_surface(fresh)
            vertices += _rows_that_differ(surface.vertices_m, expected.vertices_m)
            vertices += _rows_that_differ(surface.faces, expected.faces)
            progress("equality", done, edits)
    what = f"after {edits} edits, exclusions and threshold changes"
    return [
        Figure(name=f"{what}: voxels that differ from scratch", value=voxels, wanted="<= 0"),
        Figure(
            name=f"{what}: vertices and faces that differ from scratch",
            value=vertices,
            wanted="<= 0",
        ),
    ]


def _random_edit(
    volume: VoteVolume,
    numbers: list[int],
    scripts: tuple[Edits, Edits],
    random: np.random.Generator,
) -> None:
    kind = random.choice(["drag", "outline", "exclude", "threshold"], p=[0.6, 0.2, 0.1, 0.1])
    if kind == "threshold":
        least = max(1, volume.view_count - 3)
        volume.threshold = int(random.integers(least, volume.view_count + 1))
    elif kind == "exclude":
        _exclude_or_include(volume, int(random.choice(numbers)))
    else:
        number, view = next(scripts[0 if kind == "drag" else 1])
        volume.replace(numbers[number], view)


def _exclude_or_include(volume: VoteVolume, number: int) -> None:
    if not volume.voters[number].votes:
        volume.include(number)
    elif volume.view_count > 4:
        # A threshold above the number of views is refused.
        volume.threshold = None
        volume.exclude(number)


def _from_scratch(volume: VoteVolume) -> VoteVolume:
    fresh = VoteVolume(volume.grid)
    fresh.add_many(voter.view for voter in volume.voters.values() if voter.votes)
    fresh.threshold = volume.threshold
    return fresh


def _rows_that_differ(one: NDArray[Any], other: NDArray[Any]) -> int:
    if one.shape != other.shape:
        return max(len(one), len(other))
    return int(np.count_nonzero((one != other).any(axis=1)))
