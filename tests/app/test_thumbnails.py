from collections.abc import Iterator
from dataclasses import replace

import cv2
import httpx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.playback import Playback
from app.thumbnails import OUTLINE_RGB, SHAPE, png, thumbnail
from core.silhouettes.silhouette import Silhouette
from tests.app.running import running
from tests.app.synthetic import SETTINGS, frames, source

FRAME = next(frames(1))


def square(row: float, column: float, side: float) -> Silhouette:
    corners = side * np.array([[0, 0], [0, 1], [1, 1], [1, 0]]) + np.array([row, column])
    return Silhouette(rings=(corners,), image_shape=FRAME.shape, claim="lit side")


def outline(picture: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return first and last (row, column) of the outline's colour."""
    away = np.abs(picture.astype(int) - OUTLINE_RGB).sum(axis=2)
    place = np.argwhere(away < 120)
    return place.min(axis=0), place.max(axis=0)


@settings(max_examples=25, deadline=None)
@given(row=st.floats(-5, 120), column=st.floats(-5, 120), side=st.floats(4, 60), tall=st.booleans())
def test_an_outline_lies_in_the_middle_in_true_proportion(row, column, side, tall):
    frame = replace(FRAME, row_spacing_m=0.4 if tall else 0.2, column_spacing_m=0.2)
    picture = thumbnail(frame, square(row, column, side))
    assert picture.shape == (*SHAPE, 3)
    first, last = outline(picture)
    height, width = (last - first).tolist()
    assert abs(height / width - (2 if tall else 1)) < 0.12
    assert np.abs((first + last) / 2 - (np.array(SHAPE) - 1) / 2).max() <= 1
    assert 45 < height < 60 or width > 60


def test_a_bright_point_lies_where_the_outline_around_it_says():
    amplitude = np.full(FRAME.shape, 1e-3)
    amplitude[60:63, 90:93] = 1.0
    # The square's edges lie 10 pixels from the point's middle on each side.
    picture = thumbnail(replace(FRAME, amplitude=amplitude), square(51, 81, 20))
    bright = np.argwhere(picture.min(axis=2) > 150)
    assert np.abs(bright.mean(axis=0) - (np.array(SHAPE) - 1) / 2).max() < 0.6


def test_a_frame_without_an_outline_is_shown_whole():
    empty = Silhouette(rings=(), image_shape=FRAME.shape, claim="lit side")
    picture = thumbnail(FRAME, empty)
    assert picture.any()
    assert np.array_equal(
        cv2.imdecode(np.frombuffer(png(picture), np.uint8), 1)[..., ::-1], picture
    )


@pytest.fixture
def client(wait_for) -> Iterator[httpx.Client]:
    """A client of a workstation of its own, since it edits an outline."""
    with (
        running(source(2), SETTINGS, Playback(speed_hz=None)) as address,
        httpx.Client(base_url=address, trust_env=False) as client,
    ):
        wait_for(lambda: client.get("/api/state").json()["status"] == "finished")
        yield client


def test_a_thumbnail_is_asked_for_again_only_when_it_has_changed(client: httpx.Client) -> None:
    path = "/api/frames/2/thumbnail"
    first = client.get(path)
    assert first.headers["content-type"] == "image/png"
    tag = first.headers["etag"]
    again = client.get(path, headers={"If-None-Match": tag})
    assert (again.status_code, again.content) == (304, b"")
    facts = client.get("/api/frames/2").json()["silhouette"]
    corners = [[40.0, 40.0], [40.0, 120.0], [120.0, 120.0], [120.0, 40.0]]
    edit = {"rings": [corners], "claim": "lit side", "base_revision": facts["revision"]}
    client.put("/api/frames/2/silhouette", json=edit).raise_for_status()
    edited = client.get(path, headers={"If-None-Match": tag})
    assert edited.status_code == 200
    assert edited.headers["etag"] != tag
    assert edited.content != first.content
    step = {"base_revision": facts["revision"] + 1}
    client.post("/api/frames/2/undo", json=step).raise_for_status()
    assert client.get(path).content == first.content
    assert client.get("/api/frames/99/thumbnail").status_code == 404
