import numpy as np
import pytest

from core.experiments.physics.bad_silhouettes import cut_in_half
from core.registration.registration import registered
from tests.registration.shifting import (
    body_views,
    left_px,
    random_offsets,
    rms,
    shifted,
)


@pytest.fixture(scope="module")
def found():
    views = body_views(16)
    offsets = random_offsets(views)
    seen = shifted(views, offsets)
    seen[3] = cut_in_half(seen[3])
    return views, offsets, seen, registered(seen)


def test_frames_are_put_back_and_the_bad_one_is_told(found):
    views, offsets, _, registration = found
    assert np.flatnonzero(registration.is_bad).tolist() == [3]
    good = np.setdiff1d(np.arange(16), 3)
    left = left_px(registration.offsets_px[good], offsets[good], [views[each] for each in good])
    assert rms(left) < 0.5
    assert registration.residual_px[3] > 2 * np.median(registration.residual_px)


def test_projections_are_moved_by_the_offsets(found):
    _, _, seen, registration = found
    projection = registration.projection(2, seen[2].projection)
    assert projection.matrix[:, 3] - seen[2].projection.matrix[:, 3] == pytest.approx(
        registration.offsets_px[2]
    )


def test_two_views_are_too_few():
    with pytest.raises(ValueError, match="at least 3 views that show a target, 2 do"):
        registered(body_views(2))
