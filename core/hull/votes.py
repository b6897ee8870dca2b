"""Vote counts: how many views see each voxel inside or on their silhouette.

A vote is the paper's test (eqs. 20 to 24) on the outline itself, never on a rasterised mask.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from threading import RLock

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.geometry.grid import VoxelGrid
from core.hull.casting import UNWATCHED, Watch, cast
from core.hull.changes import changed_edges
from core.hull.outline import Outline, outline_of
from core.hull.pullback import PulledBack, index_to_image, line_axis, pulled_back
from core.hull.view import View

Votes = NDArray[np.uint8] | NDArray[np.uint16]

MOST_BYTE_VIEWS = 255
MOST_VIEWS = 65535

MOST_STORED_VOXELS = 2**30
"""Voxels that one volume in memory may hold: 1024³, 2 GiB of votes and 4 GiB while meshed."""

BYTES_PER_VOXEL = 6
"""Two of votes, and four of the mesher's copy."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Voter:
    """A view made ready to vote on one grid.

    Attributes:
        view: as it was given.
        outline: of its silhouette, valid and outset.
        to_image: 3 × 4 from homogeneous voxel indices to the homogeneous image.
        axis: of the grid lines that it is swept along.
        votes: whether its votes are in the volume; an excluded view keeps its place without.
    """

    view: View
    outline: Outline
    to_image: Floats
    axis: int
    votes: bool = True

    @classmethod
    def of(cls, view: View, grid: VoxelGrid) -> "Voter":
        """Return the voter of a view.

        Raises:
            ValueError: an outline without area, or a camera that stands in the grid.
        """
        return cls(
            view=view,
            outline=outline_of(view.silhouette),
            to_image=index_to_image(view.projection, grid),
            axis=line_axis(view.projection),
        )

    def pulled_back(self, weight: int) -> PulledBack:
        """Return the whole outline as the sweep needs it, a vote counting `weight`."""
        weights = np.full(len(self.outline.offsets) - 1, weight, dtype=np.int64)
        outline = self.outline
        return pulled_back(outline.points, outline.offsets, weights, self.to_image, self.axis)


def check_storable(grid: VoxelGrid) -> None:
    """Refuse a grid whose votes memory cannot hold.

    Raises:
        ValueError: more than `MOST_STORED_VOXELS` voxels.
    """
    if grid.voxel_count > MOST_STORED_VOXELS:
        gibibytes = -(-BYTES_PER_VOXEL * grid.voxel_count // 2**30)
        raise ValueError(
            f"A grid of {grid.shape} holds {grid.voxel_count:,} voxels; storing their votes "
            f"and meshing them would need {gibibytes:,} GiB; at most {MOST_STORED_VOXELS:,} "
            "fit. Use a larger spacing, or carved_surface of core.hull.hull_only, which "
            "stores no votes."
        )


class VoteCounts:
    """Votes of any number of views on one grid.

    One thread writes at a time, any number may read: every method waits for a running change to
    end. `votes` is the volume itself, to be read under `reading()` while others may write.
    """

    def __init__(self, grid: VoxelGrid) -> None:
        """Start with no views and no votes on `grid`.

        Raises:
            ValueError: a grid whose votes memory cannot hold.
        """
        check_storable(grid)
        self.grid = grid
        self._votes: Votes = np.zeros(grid.shape, dtype=np.uint8)
        self._voters: dict[int, Voter] = {}
        self._next_id = 0
        self._revision = 0
        self._threshold: int | None = None
        self._changed_at = np.zeros(grid.shape[0], dtype=np.int64)
        self._lock = RLock()

    @property
    def votes(self) -> Votes:
        """(nx, ny, nz) votes per voxel, uint8 up to 255 views and uint16 past that, read-only."""
        view = self._votes.view()
        view.flags.writeable = False
        return view

    @property
    def view_count(self) -> int:
        """How many views vote; excluded ones do not."""
        return sum(voter.votes for voter in self._voters.values())

    @property
    def revision(self) -> int:
        """A number that grows with every change."""
        return self._revision

    @property
    def threshold(self) -> int | None:
        """Votes that a voxel of the hull has at least; None, at first, means all views'."""
        return self._threshold

    @threshold.setter
    def threshold(self, threshold: int | None) -> None:
        with self._lock:
            self._threshold = None if threshold is None else self.checked_threshold(threshold)
            self._revision += 1
            self._changed_at[:] = self._revision

    def planes_changed_since(self, revision: int) -> NDArray[np.bool_]:
        """Return (nx,) in which planes x a voxel may have entered or left the hull since then."""
        changed: NDArray[np.bool_] = self._changed_at > revision
        return changed

    @property
    def voters(self) -> dict[int, Voter]:
        """The views by number, excluded ones included."""
        return dict(self._voters)

    def reading(self) -> RLock:
        """Return the lock under which nothing changes: `with volume.reading(): ...`."""
        return self._lock

    def repair_note(self, number: int) -> str:
        """Return what was repaired in a view's outline, empty when nothing was."""
        return self._voter(number).outline.repair

    def add(self, view: View) -> int:
        """Let one more view vote and return its number.

        Raises:
            ValueError: an outline without area, or a camera that stands in the grid.
        """
        return self.add_many([view])[0]

    def add_many(self, views: Iterable[View], watch: Watch = UNWATCHED) -> list[int]:
        """Let views vote, all in one sweep, and return their numbers.

        Args:
            views: that come.
            watch: is told the progress, and may cancel; the volume is then as it was before.

        Raises:
            ValueError: an outline without area, or a camera that stands in the grid.
            Cancelled: `watch` said so.
        """
        with self._lock:
            voters = [Voter.of(view, self.grid) for view in views]
            self._make_room(self.view_count + len(voters))
            parts = [voter.pulled_back(1) for voter in voters]
            self._cast(parts, [voter.axis for voter in voters], watch=watch)
            self._changed_at[:] = self._revision
            numbers = list(range(self._next_id, self._next_id + len(voters)))
            self._voters.update(zip(numbers, voters, strict=True))
            self._next_id += len(voters)
            return numbers

    def remove(self, number: int) -> None:
        """Take a view and its votes out.

        Raises:
            ValueError: there is no such view.
        """
        with self._lock:
            self.exclude(number)
            del self._voters[number]

    def exclude(self, number: int) -> None:
        """Take a view's votes back but keep the view, to be included again.

        Raises:
            ValueError: there is no such view.
        """
        self._set_voting(number, voting=False)

    def include(self, number: int) -> None:
        """Let an excluded view vote again.

        Raises:
            ValueError: there is no such view.
        """
        self._set_voting(number, voting=True)

    def replace(self, number: int, view: View) -> None:
        """Put another view in a view's place; only the edges that differ are swept.

        Raises:
            ValueError: there is no such view, an outline without area, or a camera in the grid.
        """
        with self._lock:
            old = self._voter(number)
            new = replace(Voter.of(view, self.grid), votes=old.votes)
            if old.votes:
                change = _change(old, new)
                limit = self.checked_threshold(self.threshold)
                parts, axes = [part for part, _ in change], [axis for _, axis in change]
                flipped = self._cast(parts, axes, limit)
                self._changed_at[flipped] = self._revision
            self._voters[number] = new

    def hull(self, threshold: int | None = None) -> NDArray[np.bool_]:
        """Return the voxels with at least `threshold` votes (eq. 25), by default the volume's.

        Raises:
            ValueError: no views yet, or a threshold outside 1 … number of views.
        """
        with self._lock:
            wanted = self.threshold if threshold is None else threshold
            inside: NDArray[np.bool_] = self._votes >= self.checked_threshold(wanted)
            return inside

    def checked_threshold(self, threshold: int | None) -> int:
        """Return the threshold, or the number of views for None, after checking it."""
        return checked_threshold(threshold, self.view_count)

    def _voter(self, number: int) -> Voter:
        if number not in self._voters:
            known = ", ".join(map(str, self._voters)) or "none"
            raise ValueError(f"There is no view number {number} in this volume; it has {known}.")
        return self._voters[number]

    def _set_voting(self, number: int, *, voting: bool) -> None:
        with self._lock:
            voter = self._voter(number)
            if voter.votes == voting:
                return
            self._make_room(self.view_count + voting)
            self._cast([voter.pulled_back(1 if voting else -1)], [voter.axis])
            self._voters[number] = replace(voter, votes=voting)
            self._changed_at[:] = self._revision

    def _make_room(self, views: int) -> None:
        """Widen the votes to 16 bits when 8 cannot hold as many."""
        if views > MOST_VIEWS:
            raise ValueError(f"A vote volume holds at most {MOST_VIEWS:,} views; got {views:,}.")
        if views > MOST_BYTE_VIEWS and self._votes.dtype == np.uint8:
            self._votes = self._votes.astype(np.uint16)

    def _cast(
        self,
        parts: Sequence[PulledBack],
        axes: Sequence[int],
        limit: int = 0,
        watch: Watch = UNWATCHED,
    ) -> NDArray[np.bool_]:
        flipped = cast(self._votes, parts, axes, limit, watch)
        self._revision += 1
        return flipped


def checked_threshold(threshold: int | None, count: int) -> int:
    """Return the threshold, or the number of views for None.

    Raises:
        ValueError: no views, or a threshold outside 1 … `count`.
    """
    if count == 0:
        raise ValueError("No views have voted yet; add at least two views of the target.")
    if threshold is None:
        return count
    if not 1 <= threshold <= count:
        raise ValueError(
            f"The vote threshold must lie between 1 and the number of views, "
            f"{count}; got {threshold}."
        )
    return threshold


def _change(old: Voter, new: Voter) -> list[tuple[PulledBack, int]]:
    """Return what to sweep, and along which axis, so that `new` votes in the place of `old`."""
    if np.array_equal(old.to_image, new.to_image):
        points, offsets, weights = changed_edges(old.outline, new.outline)
        return [(pulled_back(points, offsets, weights, new.to_image, new.axis), new.axis)]
    return [(old.pulled_back(-1), old.axis), (new.pulled_back(1), new.axis)]
