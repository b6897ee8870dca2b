import numpy as np
import pytest

from core.registration.registration import Registration, registered
from tests.registration.shifting import (
    body_views,
    cut_in_half,
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
    assert registration.sentence().endswith("contradicting silhouettes: 4.")


def test_projections_are_moved_by_the_offsets(found):
    _, _, seen, registration = found
    projection = registration.projection(2, seen[2].projection)
    assert projection.matrix[:, 3] - seen[2].projection.matrix[:, 3] == pytest.approx(
        registration.offsets_px[2]
    )


def test_drift_and_jumps_are_told():
    offsets = np.column_stack([0.5 * np.arange(10), np.zeros(10)])
    offsets[6:, 1] += 8.0
    registration = Registration(
        offsets_px=offsets, residual_px=np.zeros(10), is_bad=np.zeros(10, dtype=bool)
    )
    assert registration.drift_px_per_frame[0] == pytest.approx(0.5)
    assert int(np.argmax(registration.steps_px)) == 6
    assert registration.steps_px[6] == pytest.approx(np.hypot(0.5, 8))
    assert "largest jump 8.0 px before frame 7." in registration.sentence()


def test_two_views_are_too_few():
    with pytest.raises(ValueError, match="at least 3 views that show a target, 2 do"):
        registered(body_views(2))
