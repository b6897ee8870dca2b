import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats
from scipy.spatial.transform import Rotation

from core.geometry.projection import Projection
from core.measurement.key_points import image_derivative, length_between, located

CORNER_M = np.array([1.0, -2.0, 0.5])


def parallel(turn, pixel_m=0.1):
    return Projection(matrix=np.column_stack([turn[:2] / pixel_m, [63.5, 60.0]]))


def perspective(turn, distance_m=15.0, focal_px=150.0):
    camera = np.diag([focal_px, focal_px, 1.0]) @ np.column_stack([turn, [0, 0, distance_m]])
    camera[:2] += np.outer([63.5, 60.0], camera[2])
    return Projection(matrix=camera)


def around(count, seed, kinds=(parallel,)):
    turns = Rotation.random(count, rng=np.random.default_rng(seed)).as_matrix()
    return [kinds[n % len(kinds)](turn) for n, turn in enumerate(turns)]


KINDS = st.sampled_from([(parallel,), (perspective,), (parallel, perspective)])


def marks(projections, point_m=CORNER_M):
    return np.array([projection.image_points(point_m) for projection in projections])


@settings(max_examples=30)
@given(seed=st.integers(0, 10**6), count=st.integers(4, 9), kinds=KINDS)
def test_exact_marks_give_the_corner_itself(seed, count, kinds):
    projections = around(count, seed, kinds)
    found = located("corner", projections, marks(projections), sigma_px=1.0)
    assert found.position_m == pytest.approx(CORNER_M, abs=1e-6)
    assert found.residual_px == pytest.approx(np.zeros(count), abs=1e-5)


@settings(max_examples=30)
@given(seed=st.integers(0, 10**6), kinds=KINDS)
def test_the_derivative_is_the_finite_difference(seed, kinds):
    projection = around(2, seed, kinds)[-1]
    step = 1e-6 * np.eye(3)
    differences = projection.image_points(CORNER_M + step) - projection.image_points(
        CORNER_M - step
    )
    assert image_derivative(projection, CORNER_M) == pytest.approx(
        differences.T / 2e-6, rel=1e-5, abs=1e-5
    )


@pytest.mark.parametrize("kinds", [(parallel,), (perspective, parallel)])
def test_the_covariance_is_that_of_the_scatter(kinds):
    projections, random = around(5, 3, kinds), np.random.default_rng(1)
    exact, draws = marks(projections), 200
    found = [
        located("corner", projections, exact + random.normal(0, 0.5, exact.shape), sigma_px=0.5)
        for _ in range(draws)
    ]
    errors = np.array([point.position_m for point in found]) - CORNER_M
    inverse = np.linalg.inv(found[0].covariance_m2)
    distances = np.einsum("ni,ij,nj->n", errors, inverse, errors)
    assert stats.kstest(distances, stats.chi2(3).cdf).pvalue > 0.01
    # (n − 1) C⁻¹ S is of Wishart's distribution, its trace of chi-square's.
    trace = (draws - 1) * np.trace(inverse @ np.cov(errors.T))
    assert stats.chi2(3 * (draws - 1)).cdf(trace) == pytest.approx(0.5, abs=0.495)


def test_an_estimated_sigma_is_the_marks_own():
    projections, random = around(6, 5), np.random.default_rng(2)
    exact = marks(projections)
    sigmas = []
    for _ in range(300):
        found = located("corner", projections, exact + random.normal(0, 0.7, exact.shape))
        assert found.degrees_of_freedom == 9
        sigmas.append(found.sigma_px)
    assert np.mean(np.square(sigmas)) == pytest.approx(0.49, rel=0.06)


@pytest.mark.parametrize("sigma_px", [0.4, None])
def test_intervals_of_a_length_hold_it_in_95_of_100_draws(sigma_px):
    projections, random = around(4, 7), np.random.default_rng(3)
    other_m = np.array([-2.0, 1.0, 0.0])
    true_m, held, lengths = np.linalg.norm(other_m - CORNER_M), 0, []
    for _ in range(400):
        ends = [
            located(
                name,
                projections,
                marks(projections, point_m) + random.normal(0, 0.4, (4, 2)),
                sigma_px=sigma_px,
            )
            for name, point_m in (("tip", CORNER_M), ("root", other_m))
        ]
        lengths.append(length_between(*ends))
        held += lengths[-1].low_m <= true_m <= lengths[-1].high_m
    assert 0.92 <= held / 400 <= 0.985
    if sigma_px is not None:
        scatter = np.std([length.value_m for length in lengths])
        assert lengths[0].standard_error_m == pytest.approx(scatter, rel=0.1)
    assert lengths[0].direction @ (other_m - CORNER_M) / true_m > 0.99


def test_frames_of_one_plane_leave_their_normal_undetermined():
    tilts = [Rotation.from_rotvec([angle, 0.0, 0.0]).as_matrix() for angle in (0, 0.02, 0.04)]
    projections = [parallel(tilt) for tilt in tilts]
    with pytest.raises(ValueError, match=r"edge .* nearly the same line, \(-?0.00, -?0.02, 1.00\)"):
        located("edge", projections, marks(projections))
    across = parallel(Rotation.from_rotvec([0.5, 0.0, 0.0]).as_matrix())
    seen = [*projections, across]
    assert located("edge", seen, marks(seen)).position_m == pytest.approx(CORNER_M)


def test_cameras_at_one_place_leave_the_depth_undetermined():
    turns = [Rotation.from_rotvec([0, 0, angle]).as_matrix() for angle in (0.0, 0.5, 1.0)]
    cameras = [perspective(turn) for turn in turns]
    with pytest.raises(ValueError, match=r"tip .* nearly the same line, .*; mark it in a frame"):
        located("tip", cameras, marks(cameras))


def test_what_cannot_be_located_is_refused():
    projections = around(3, 1)
    exact = marks(projections)
    with pytest.raises(ValueError, match="marked in 1 frame"):
        located("tip", projections[:1], exact[:1])
    with pytest.raises(ValueError, match="wanted an array of shape 3 × 2"):
        located("tip", projections, exact[:2])
    with pytest.raises(ValueError, match="must be positive pixels, got 0"):
        located("tip", projections, exact, sigma_px=0)
    tip = located("tip", projections, exact)
    with pytest.raises(ValueError, match="tip and tip are the same point"):
        length_between(tip, tip)


def test_a_corner_behind_a_camera_is_refused():
    cameras = around(3, 2, (perspective,))
    behind = -18.0 * cameras[0].matrix[2, :3]
    with pytest.raises(ValueError, match="tip would lie behind a camera"):
        located("tip", cameras, marks(cameras, behind))
