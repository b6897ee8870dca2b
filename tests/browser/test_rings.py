"""The page's geometry of outlines against shapely's, in the browser that runs it."""

import re
from collections.abc import Iterator
from functools import reduce
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from playwright.sync_api import Browser, Page
from shapely import LineString, MultiPoint, Polygon, is_valid
from shapely.ops import unary_union

from app.playback import Playback
from core.hull.shadow import shadow_region
from core.silhouettes.areas import area_of
from core.silhouettes.silhouette import Silhouette, clockwise_area_px
from tests.app.running import running
from tests.app.synthetic import SETTINGS, source

EXAMPLES = settings(max_examples=25, deadline=None)

Ring = list[list[float]]

places = st.tuples(st.floats(0, 60), st.floats(0, 60)).map(
    lambda place: [round(place[0], 2), round(place[1], 2)]
)


@pytest.fixture(scope="module")
def page(browser: Browser) -> Iterator[Page]:
    with running(source(1), SETTINGS, Playback(speed_hz=None, is_playing=False)) as address:
        page = browser.new_page()
        page.route(re.compile(r":\d+/viewport/"), lambda route: route.fulfill(body=""))
        page.goto(address)
        yield page
        page.close()


def call(page: Page, function: str, *arguments: Any) -> Any:
    """Return what a function of the page's module gives."""
    return page.evaluate(
        """async ([name, values]) => (await import("/modules/rings.js"))[name](...values)""",
        [function, list(arguments)],
    )


def star(radii: list[float], row: float, column: float) -> Ring:
    """A ring that sees its middle from everywhere."""
    angle = 2 * np.pi * np.arange(len(radii)) / len(radii)
    rows, columns = row + radii * np.sin(angle), column + radii * np.cos(angle)
    return np.column_stack([rows, columns]).round(3).tolist()


stars = st.builds(
    star,
    st.lists(st.floats(3, 20), min_size=5, max_size=12).map(np.array),
    st.floats(20, 40),
    st.floats(20, 40),
)


def area_px(rings: list[Ring]) -> float:
    """Holes count less, which holds only where every ring runs the way that it should."""
    return sum(clockwise_area_px(np.array(ring)) for ring in rings)


def shape(rings: list[Ring]) -> Any:
    return reduce(lambda whole, ring: whole ^ Polygon(ring), rings, Polygon())


@given(first=stars, second=stars, how=st.sampled_from(["add", "cut", "replace"]))
@EXAMPLES
def test_regions_are_added_and_cut_out_as_sets(page, first: Ring, second: Ring, how: str) -> None:
    rings = call(page, "combined", [first], second, how)
    drawn, region = Polygon(first), Polygon(second)
    wanted = {"add": drawn | region, "cut": drawn - region, "replace": region}[how]
    assert area_px(rings) == pytest.approx(wanted.area, abs=1e-6)
    assert (shape(rings) ^ wanted).area < 1e-6


@given(
    ring=stars,
    points=st.lists(places, min_size=1, max_size=5),
    radius=st.floats(2, 8),
    adds=st.booleans(),
)
@EXAMPLES
def test_a_brush_reaches_as_far_as_its_radius(
    page, ring: Ring, points: list[list[float]], radius: float, adds: bool
) -> None:
    rings = call(page, "brushed", [ring], points, radius, adds)
    line = LineString(points) if len(points) > 1 else MultiPoint(points)
    # A disc of 24 corners lacks 0.9 % of the radius between them; close points are thinned out.
    # (Shapely's discs have corners too, hence the thousandth.)
    most, least = line.buffer(1.001 * radius), line.buffer(0.7 * radius)
    drawn = Polygon(ring)
    wanted = [drawn | stroke if adds else drawn - stroke for stroke in (least, most)]
    inner, outer = wanted if adds else wanted[::-1]
    found = shape(rings)
    assert area_px(rings) == pytest.approx(found.area, abs=1e-6)
    assert (inner - found).area < 1e-3
    assert (found - outer).area < 1e-3


@given(ring=stars, index=st.integers(0, 4), move=places, reach=st.floats(0, 30))
@EXAMPLES
def test_a_moved_vertex_pulls_only_what_is_in_reach(
    page, ring: Ring, index: int, move: list[float], reach: float
) -> None:
    assert is_valid(Polygon(ring))
    moved = np.array(call(page, "moved", [ring], {"ring": 0, "index": index}, move, reach)[0])
    before = np.array(ring)
    steps = np.linalg.norm(np.roll(before, -1, axis=0) - before, axis=1)
    along = np.concatenate([[0], np.cumsum(np.roll(steps, -index))[:-1]])
    distance = np.roll(np.minimum(along, steps.sum() - along), index)
    weight = np.where(distance < reach, 0.5 + 0.5 * np.cos(np.pi * distance / max(reach, 1e-9)), 0)
    weight[index] = 1
    np.testing.assert_allclose(moved, before + weight[:, None] * move, atol=1e-9)


@EXAMPLES
@given(ring=stars)
def test_the_shadow_on_the_page_is_the_one_by_which_the_hull_is_carved(page, ring) -> None:
    strips = call(page, "shadowStrips", [ring], 79.5)
    # The canvas joins them by the non-zero rule, so that all must run one way around.
    assert all(clockwise_area_px(np.array(strip)) > 0 for strip in strips)
    shown = unary_union([Polygon(strip) for strip in strips]).difference(Polygon(ring))
    silhouette = Silhouette(rings=(np.array(ring),), image_shape=(80, 80), claim="lit side")
    wanted = area_of(shadow_region(silhouette))
    assert shown.symmetric_difference(wanted).area < 1e-6 * wanted.area + 1e-6
