import numpy as np
import pytest

from core.silhouettes.editing.brush import combined, combined_rings, painted
from core.silhouettes.editing.disagreement import disagreement
from core.silhouettes.editing.smoothing import simplified, smoothed, without_holes
from core.silhouettes.editing.snapping import snapped
from core.silhouettes.editing.transfer import copied
from tests.silhouettes.editing.shapes import SHAPE, box, frame_of

FRAME = frame_of(np.ones(SHAPE))


@pytest.mark.parametrize(
    "tool",
    [
        lambda rings: painted(rings, SHAPE, [(5, 5)], 2.0, add=False),
        lambda rings: combined(rings, box(1, 1, 5, 5)[0], "intersect"),
        lambda rings: combined_rings(rings, rings, "add"),
        lambda rings: simplified(rings, 1.0),
        lambda rings: smoothed(rings, 1.0),
        without_holes,
        lambda rings: snapped(rings, FRAME, 2.0),
        lambda rings: copied(rings, FRAME, FRAME),
        lambda rings: disagreement(rings, rings).only_outline,
    ],
)
def test_an_empty_outline_stays_empty(tool):
    assert tool(()) == ()
