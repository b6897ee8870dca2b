import numpy as np
import pytest

from core.measurement.comparison import voxel_agreement


def test_agreement_counts_shared_voxels():
    truth = np.zeros((4, 4, 4), bool)
    hull = truth.copy()
    truth[:2], hull[1:3] = True, True
    agreement = voxel_agreement(hull, truth)
    assert agreement.intersection_over_union == pytest.approx(1 / 3)
    assert agreement.coverage == pytest.approx(1 / 2)


def test_a_body_without_voxels_is_refused():
    with pytest.raises(ValueError, match="fills no voxel"):
        voxel_agreement(np.ones((2, 2, 2), bool), np.zeros((2, 2, 2), bool))
