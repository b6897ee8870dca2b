"""`radarhull bench carve`: all votes of all views, the engine against its peers."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from core.benchmarks.measuring import Progress, machine, measured, median_s, peak_bytes
from core.benchmarks.peers import PEERS, Peer
from core.benchmarks.reference import every_nth_plane, reference_stride, reference_votes
from core.benchmarks.workload import Task, degenerate_task, satellite_task
from core.experiments.results import Figure, Results, Table
from core.hull.volume import VoteVolume

ENGINE = "radarhull"
SIZES = ((256, 60), (512, 120))
WANTED_RATIOS = {
    (256, 60): {
        "the fastest peer": ">= 20",
        "Open3D carve_silhouette": ">= 300",
        "shapely": ">= 1000",
        "NumPy mask": ">= 1000",
    },
    (512, 120): {"the fastest peer": ">= 15"},
}

ONCE_PAST_BUDGETS = 3
"""A peer that cannot be measured on a part, and takes so many budgets, runs once."""

Votes = NDArray[Any]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Contender:
    """The engine or a peer, ready to run on one task.

    Attributes:
        name: as shown.
        run: returns votes (planes, ny, nz).
        planes: which it computes.
        stride: it computes every n-th plane; its times are given times n.
        hull_only: whether its votes are all or none.
    """

    name: str
    run: Callable[[], Votes]
    planes: NDArray[np.int64]
    stride: int = 1
    hull_only: bool = False

    @property
    def share(self) -> str:
        """How its figures are named where it was measured on a part only."""
        return "" if self.stride == 1 else f", scaled from 1/{self.stride} of the slices"


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """What one contender did.

    Attributes:
        contender: who.
        seconds: for the whole volume, one per repeat.
        peak_bytes: of one run; not scaled.
        wrong_votes: voxels whose votes differ from the reference; None if it does not count.
        wrong_hull: voxels that are in one hull and not in the other.
        compared: voxels that were compared.
        hull: voxels of the reference's hull among them.
    """

    contender: Contender
    seconds: tuple[float, ...]
    peak_bytes: int
    wrong_votes: int | None
    wrong_hull: int
    compared: int
    hull: int

    @property
    def median_s(self) -> float:
        """Median time for the whole volume."""
        return median_s(self.seconds)


def run_carve(
    *,
    sizes: Sequence[tuple[int, int]] = SIZES,
    repeats: int = 5,
    budget_s: float = 4.0,
    seed: int = 1,
    progress: Progress = lambda _stage, _done, _total: None,
) -> Results:
    """Race the engine and every installed peer and compare their votes with the exact ones.

    Args:
        sizes: (voxels a side, views).
        repeats: runs of each contender; the median counts.
        budget_s: a peer that would take longer than this for the whole volume is measured on
            every n-th slice, and its figure says so; where it cannot be, it runs once.
        seed: of the views.
        progress: told of stage, steps done and steps in all.
    """
    figures: list[Figure] = []
    tables: list[Table] = []
    before = machine()
    for size, views in sizes:
        title = f"{size}³×{views}"
        outcomes = _race(
            satellite_task(size, views, seed=seed, masks=True), title, repeats, budget_s, progress
        )
        figures += _figures(title, outcomes, WANTED_RATIOS.get((size, views), {}))
        tables.append(_table(title, outcomes))
    # One plane in a hundred of the degenerate grid would cost as much as all of it.
    outcomes = _race(degenerate_task(seed=seed), "degenerate", 1, np.inf, progress)
    figures.append(_wrong_votes("degenerate views and holes", outcomes[0]))
    tables.append(_table("degenerate views and holes", outcomes))
    return Results(
        name="carve",
        settings=_settings(sizes, repeats, budget_s, seed, before),
        figures=tuple(figures),
        tables=tuple(tables),
    )


def _settings(
    sizes: Sequence[tuple[int, int]],
    repeats: int,
    budget_s: float,
    seed: int,
    before: dict[str, object],
) -> dict[str, object]:
    return {
        "sizes": [f"{size}x{views}" for size, views in sizes],
        "repeats": repeats,
        "budget_s": budget_s,
        "seed": seed,
        **before,
        "load_average_at_end": machine()["load_average"],
        "peers": {peer.name: peer.version or "not installed" for peer in PEERS},
        "peers' masks": "given, not timed",
    }


def _race(
    task: Task, title: str, repeats: int, budget_s: float, progress: Progress
) -> list[Outcome]:
    """Return what the engine (first) and every peer that can did, all interleaved."""
    planes = every_nth_plane(task.grid.shape[0], reference_stride(task))
    progress(f"{title}: exact votes", 0, 1)
    reference = reference_votes(task, planes)
    progress(f"{title}: exact votes", 1, 1)
    contenders = _contenders(task, budget_s)
    steps = len(contenders) * (repeats + 1)
    outcomes = []
    for each in contenders:
        peak, votes = peak_bytes(each.run)
        outcome = _compared(each, votes, planes, reference, len(task.views))
        outcomes.append(replace(outcome, peak_bytes=peak))
        progress(f"{title}: race", len(outcomes), steps)
    times: list[list[float]] = [[] for _ in contenders]
    for repeat in range(1, repeats + 1):
        for number, each in enumerate(contenders):
            if not times[number] or times[number][0] <= ONCE_PAST_BUDGETS * budget_s:
                times[number].append(measured(each.run).seconds)
            progress(f"{title}: race", repeat * len(contenders) + number + 1, steps)
    return [
        replace(outcome, seconds=tuple(_whole(outcome.contender, seconds) for seconds in own))
        for outcome, own in zip(outcomes, times, strict=True)
    ]


def _whole(contender: Contender, seconds: float) -> float:
    """Return the time for the whole volume."""
    return seconds * contender.stride


def _contenders(task: Task, budget_s: float) -> list[Contender]:
    whole = task.all_planes()

    def carve() -> Votes:
        volume = VoteVolume(task.grid)
        volume.add_many(task.views)
        return volume.votes

    carve()  # compiles
    found = [Contender(name=ENGINE, run=carve, planes=whole)]
    fits = [peer for peer in PEERS if np.prod(task.grid.shape) <= peer.most_voxels]
    found += [_peer_contender(task, peer, budget_s) for peer in fits if peer.version is not None]
    return found


def _peer_contender(task: Task, peer: Peer, budget_s: float) -> Contender:
    """Return a peer with all planes, or as many as it can do within the budget, warmed up."""
    votes = peer.function()
    planes, stride = task.all_planes(), 1
    if not peer.whole_only:
        planes, stride = _affordable(votes, task, budget_s)
    elif not peer.hull_only:
        votes(task, planes)  # compiles
    return Contender(
        name=peer.name,
        run=lambda: votes(task, planes),
        planes=planes,
        stride=stride,
        hull_only=peer.hull_only,
    )


def _affordable(
    votes: Callable[[Task, NDArray[np.int64]], Votes], task: Task, budget_s: float
) -> tuple[NDArray[np.int64], int]:
    """Return the planes, and their stride, that a peer is likely to do within the budget."""
    count = task.grid.shape[0]
    stride = 1 << int(np.log2(count // 2))
    while True:
        planes = every_nth_plane(count, stride)
        seconds = measured(lambda planes=planes: votes(task, planes)).seconds  # type: ignore[misc]
        if stride == 1 or 2 * seconds > budget_s:
            return planes, stride
        stride //= 2


def _compared(
    contender: Contender,
    votes: Votes,
    planes: NDArray[np.int64],
    reference: NDArray[np.uint16],
    views: int,
) -> Outcome:
    common, mine, its = np.intersect1d(contender.planes, planes, return_indices=True)
    wrong_votes = wrong_hull = hull = 0
    for at, right_at in zip(mine, its, strict=True):
        found, right = votes[at], reference[right_at]
        wrong_votes += int(np.count_nonzero(found != right))
        wrong_hull += int(np.count_nonzero((found == views) != (right == views)))
        hull += int(np.count_nonzero(right == views))
    return Outcome(
        contender=contender,
        seconds=(),
        peak_bytes=0,
        wrong_votes=None if contender.hull_only else wrong_votes,
        wrong_hull=wrong_hull,
        compared=len(common) * reference[0].size,
        hull=hull,
    )


def _figures(title: str, outcomes: list[Outcome], wanted: dict[str, str]) -> list[Figure]:
    engine, *peers = outcomes
    whole = [each for each in peers if each.contender.stride == 1]
    fastest = min(whole or peers, key=lambda each: each.median_s)
    figures = [
        Figure(name=f"{title}: {ENGINE}", value=1e3 * engine.median_s, unit="ms"),
        Figure(
            name=f"{title}: times faster than the fastest peer ({fastest.contender.name})",
            value=fastest.median_s / engine.median_s,
            wanted=wanted.get("the fastest peer"),
        ),
        _wrong_votes(title, engine),
    ]
    for each in peers:
        name = each.contender.name
        figures += [
            Figure(
                name=f"{title}: {name}{each.contender.share}", value=1e3 * each.median_s, unit="ms"
            ),
            Figure(
                name=f"{title}: times faster than {name}{each.contender.share}",
                value=each.median_s / engine.median_s,
                wanted=wanted.get(name),
            ),
        ]
    figures += [
        Figure(
            name=f"{title}: peak memory, {each.contender.name}",
            value=each.peak_bytes / 2**20,
            unit="MiB",
        )
        for each in outcomes
    ]
    return figures


def _wrong_votes(title: str, engine: Outcome) -> Figure:
    return Figure(
        name=f"{title}: voxels of {engine.compared:,} whose votes differ from the reference",
        value=engine.wrong_votes,
        wanted="<= 0",
    )


def _table(title: str, outcomes: list[Outcome]) -> Table:
    engine = outcomes[0]
    return Table(
        title=f"{title}: all votes",
        columns=("", "median", "ratio", "slices", "memory", "votes wrong", "hull wrong"),
        rows=tuple(
            (
                each.contender.name,
                f"{each.median_s:.4g} s",
                f"{each.median_s / engine.median_s:.1f}",
                "all" if each.contender.stride == 1 else f"1/{each.contender.stride}",
                f"{each.peak_bytes / 2**20:.0f} MiB",
                _percent(each.wrong_votes, each.compared),
                _percent(each.wrong_hull, each.hull),
            )
            for each in outcomes
        ),
    )


def _percent(wrong: int | None, of: int) -> str:
    if wrong is None:
        return "does not count"
    return "0" if wrong == 0 else f"{100 * wrong / max(of, 1):.3g} %"
