from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from core.frame import Frame
from core.geometry.grid import VoxelGrid
from core.geometry.projection import Projection
from core.hull.casting import Cancelled, Watch
from core.hull.shadow import carving_view
from core.hull.surface import EMPTY_SURFACE
from core.hull.view import View
from core.hull.volume import VoteVolume
from core.measurement.residuals import Outlined, hull_residuals
from core.silhouettes.areas import area_of, rings_of
from core.silhouettes.silhouette import Silhouette

GRID = VoxelGrid.cube(side_m=7.0, spacing_m=0.14)
SHAPE = (140, 140)
PIXEL_M = 0.05
SEEDS = st.integers(0, 2**31)
SLIVERS = 0.06
"""Share of an outline that stays open along its edge: corners of a body cut at 0.14 m voxels."""


def outlined(random, corners, claim="complete"):
    """Return the exact outline of a convex body from somewhere."""
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    projection = Projection(matrix=np.column_stack([turn[:2] / PIXEL_M, [70.0, 70.0]]))
    hull = shapely.MultiPoint(projection.image_points(corners)).convex_hull
    frame = Frame(
        amplitude=np.ones(SHAPE),
        projection=projection,
        time_s=0.0,
        sensor="radar",
        line_of_sight=turn[0],
        row_spacing_m=PIXEL_M,
        column_spacing_m=PIXEL_M,
    )
    silhouette = Silhouette(rings=rings_of(hull), image_shape=SHAPE, claim=claim)
    return Outlined(frame=frame, silhouette=silhouette)


def outlines(seed, count=7, claim="complete"):
    random = np.random.default_rng(seed)
    half_m = random.uniform(0.8, 1.8, 3)
    corners = np.array(np.meshgrid(*([-1, 1],) * 3)).reshape(3, 8).T * half_m
    return [outlined(random, corners, claim) for _ in range(count)]


def carved(some, rule="strict"):
    views = [View(silhouette=o.silhouette, projection=o.frame.projection) for o in some]
    volume = VoteVolume(GRID)
    volume.add_many([carving_view(view, rule) for view in views])
    return volume


def residuals(some, rule="strict"):
    volume = carved(some, rule)
    return hull_residuals(volume, volume.surface(), some)


def redrawn(some, number, change):
    """Change the area of a frame's outline, in metres from the image's middle."""
    one = some[number - 1]
    area = change(area_of(one.silhouette.rings))
    drawn = replace(one.silhouette, rings=rings_of(area))
    return [*some[: number - 1], replace(one, silhouette=drawn), *some[number:]]


def half_away(area):
    """Cut off what lies beyond a third of the way to the last column."""
    left, _, right, _ = area.bounds
    return area & shapely.box(left - 1, -500, left + 0.65 * (right - left), 500)


def with_a_bump(area):
    """Add a square metre beside the outline, touching it."""
    _, middle, right, _ = area.bounds
    x, y = shapely.get_coordinates(area)[np.argmax(shapely.get_coordinates(area)[:, 0])]
    assert right == x
    assert middle <= y
    return area | shapely.box(x - 2, y - 10, x + 18, y + 10)


@settings(max_examples=5, deadline=None)
@given(seed=SEEDS, claim=st.sampled_from(["complete", "lit side"]))
def test_perfect_outlines_suffer_nothing(seed, claim):
    some = outlines(seed, claim=claim)
    for number, one in enumerate(residuals(some, "shadow"), start=1):
        assert one.number == number
        assert one.suffers_m2 < SLIVERS * one.outline_m2
        drawn_m2 = some[number - 1].silhouette.area_px() * PIXEL_M**2
        assert one.outline_m2 == pytest.approx(drawn_m2)


@settings(max_examples=5, deadline=None)
@given(seed=SEEDS)
def test_an_outline_too_small_causes_and_the_others_suffer(seed):
    some = outlines(seed)
    before, spoiled = residuals(some), redrawn(some, 3, half_away)
    after, volume = residuals(spoiled), carved(spoiled)
    kept = volume.hull().sum()
    volume.exclude(2)
    without = volume.hull().sum() - kept
    assert after[2].causes_m3 == pytest.approx(without * GRID.spacing_m**3)
    assert after[2].causes_m3 > before[2].causes_m3 + 0.2
    assert after[2].suffers_m2 < SLIVERS * after[2].outline_m2
    others = [n for n in range(7) if n != 2]
    assert max(after[n].suffers_m2 / after[n].outline_m2 for n in others) > 2 * SLIVERS
    assert all(after[n].causes_m3 <= before[n].causes_m3 for n in others)


@settings(max_examples=5, deadline=None)
@given(seed=SEEDS)
def test_an_outline_too_large_suffers_and_causes_nothing(seed):
    some = outlines(seed)
    before, after = residuals(some), residuals(redrawn(some, 3, with_a_bump))
    added_m2 = after[2].outline_m2 - before[2].outline_m2
    assert added_m2 > 0.5
    assert after[2].suffers_m2 > 0.5 * added_m2
    assert after[2].causes_m3 <= before[2].causes_m3
    others = [n for n in range(7) if n != 2]
    assert all(after[n].suffers_m2 < SLIVERS * after[n].outline_m2 for n in others)


def test_a_lit_side_that_is_smaller_than_the_hull_suffers_nothing():
    some = outlines(5, claim="lit side")

    def near_half(area):
        first, _, last, _ = area.bounds
        return area & shapely.box(first - 1, -500, (first + last) / 2, 500)

    near = residuals(redrawn(some, 2, near_half), "shadow")[1]
    assert near.suffers_m2 < SLIVERS * near.outline_m2


def test_of_no_hull_the_whole_outline_is_open_and_without_pixel_sizes_nothing_is_said():
    some = outlines(1, count=2)
    bare = replace(some[0], frame=replace(some[0].frame, row_spacing_m=None))
    volume = carved([some[0], bare])
    first, second = hull_residuals(volume, EMPTY_SURFACE, [some[0], bare])
    assert first.suffers_m2 == pytest.approx(first.outline_m2)
    assert (second.suffers_m2, second.outline_m2) == (None, None)
    volume.exclude(0)
    assert hull_residuals(volume, volume.surface(), some)[0].causes_m3 == 0


def test_residuals_are_cancelled_between_frames():
    some = outlines(2, count=3)
    volume, done = carved(some), []
    watch = Watch(progress=lambda *parts: done.append(parts), cancel=lambda: len(done) == 2)
    with pytest.raises(Cancelled, match="after 2 of 3 frames"):
        hull_residuals(volume, volume.surface(), some, watch)
