import numpy as np
import pytest
import trimesh
from hypothesis import given, settings

from core.hull.surface import EMPTY_SURFACE
from core.measurement.comparison import compare, placed, signed_distances_m, voxel_agreement
from tests.measurement.bodies import SHIFTS, TURNS, box, joined, moved, surface_of


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


@given(TURNS, SHIFTS)
@settings(max_examples=8)
def test_a_comparison_is_the_same_wherever_both_stand(turn, shift):
    hull, truth = box((4.4, 2, 1), fineness=2), box(fineness=2)
    found = compare(
        moved(hull, turn, shift),
        placed(truth, rotation=turn.as_matrix(), translation_m=shift),
        spacing_m=0.2,
        samples=2000,
    )
    # The ends stand out by 0.2 m each.
    assert found.hausdorff_m == pytest.approx(0.2, abs=1e-9)
    assert found.signed_distances_m.max() == pytest.approx(0.2)
    assert found.signed_distances_m.min() == pytest.approx(0, abs=1e-9)
    # Where faces lie on voxel centres, one of the 22 layers may fall either way.
    assert found.intersection_over_union == pytest.approx(4 / 4.4, abs=1.01 / 22)
    assert 0 < found.chamfer_m < 0.05


def test_distances_of_balls_are_those_of_their_radii():
    small, large = (
        surface_of(trimesh.creation.icosphere(subdivisions=3, radius=r)) for r in (1.0, 1.5)
    )
    found = compare(large, small, spacing_m=0.1)
    assert found.chamfer_m == pytest.approx(0.5, rel=0.01)
    assert found.hausdorff_m == pytest.approx(0.5, rel=0.01)
    assert found.intersection_over_union == pytest.approx((1 / 1.5) ** 3, rel=0.02)
    inside = compare(small, large, spacing_m=0.1)
    np.testing.assert_allclose(inside.signed_distances_m, -0.5, rtol=0.01)
    assert inside.chamfer_m == pytest.approx(found.chamfer_m)


def test_overlapping_bodies_are_one_reference():
    reference = joined(box(), box((1, 4, 1)))
    points = np.array([[0.0, 0, 0], [0, 1.8, 0], [3, 0, 0], [0, 3, 0]])
    np.testing.assert_allclose(
        signed_distances_m(points, reference), [-0.5, -0.2, 1, 1], atol=1e-12
    )


def test_references_that_are_none_are_refused():
    with pytest.raises(ValueError, match="must be a rotation"):
        placed(box(), rotation=np.diag([1.0, 1, -1]), translation_m=np.zeros(3))
    with pytest.raises(ValueError, match="The reference is empty"):
        compare(box(), EMPTY_SURFACE, spacing_m=0.1)
