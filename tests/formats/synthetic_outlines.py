"""Outlines of several parts and holes, by Hypothesis."""

import numpy as np
from hypothesis import strategies as st

from core.silhouettes.silhouette import Silhouette, clockwise_area_px

SHAPE = (40, 60)
CELL_PX = 20


def ring(centre, radius_px, angles, *, clockwise):
    """A star around a point, so that it never crosses itself."""
    angle = np.sort(np.asarray(angles))
    points = np.asarray(centre) + radius_px * np.stack([np.sin(angle), np.cos(angle)], axis=1)
    return points if (clockwise_area_px(points) > 0) == clockwise else points[::-1]


@st.composite
def angles(draw):
    """Between 3 and 7 directions with gaps of less than half a turn."""
    count = draw(st.integers(3, 7))
    jitter = draw(st.lists(st.floats(0, 0.3), min_size=count, max_size=count))
    return (np.arange(count) + np.array(jitter)) * 2 * np.pi / count


@st.composite
def silhouettes(draw, *, with_holes=True):
    """Up to three parts in cells of their own, some with a hole."""
    rings = []
    for part in range(draw(st.integers(0, 3))):
        centre = (draw(st.floats(9, 30)), 10 + CELL_PX * part + draw(st.floats(-1, 1)))
        rings.append(ring(centre, draw(st.floats(5, 8.5)), draw(angles()), clockwise=True))
        if with_holes and draw(st.booleans()):
            # A star of three corners still holds a circle of 0.13 of its radius.
            rings.append(ring(centre, draw(st.floats(0.2, 0.6)), draw(angles()), clockwise=False))
    return Silhouette(
        rings=tuple(rings),
        image_shape=SHAPE,
        claim=draw(st.sampled_from(["lit side", "complete"])),
        # A part without an outline is not there at all.
        component=draw(st.sampled_from(["target", "solar panel"])) if rings else "target",
    )


def assert_same_rings(rings, silhouette):
    assert len(rings) == len(silhouette.rings)
    for one, other in zip(rings, silhouette.rings, strict=True):
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-12)
