import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.geometry.track import LineOfSightTrack, track_from_angles
from core.radar.focus import quadratic_phase

WAVELENGTH_M, RADIUS_M, PULSES = 0.018, 9.0, 200
TO_PHASE = 4 * np.pi / WAVELENGTH_M * RADIUS_M


def phase(track):
    return quadratic_phase(
        track, 0, len(track), wavelength_m=WAVELENGTH_M, target_radius_m=RADIUS_M
    )


def turning(angle, seed):
    """A line of sight on a great circle anywhere, at the given angles from its start."""
    random = np.random.default_rng(seed)
    first, second, _ = np.linalg.qr(random.normal(size=(3, 3)))[0].T
    line_of_sight = np.outer(np.cos(angle), first) + np.outer(np.sin(angle), second)
    rate = np.gradient(line_of_sight, axis=0, edge_order=2)
    rate -= line_of_sight * np.sum(line_of_sight * rate, axis=1, keepdims=True)
    return LineOfSightTrack(
        time_s=np.arange(len(angle)),
        line_of_sight=line_of_sight,
        line_of_sight_rate_per_s=rate,
    )


@given(turn_rad=st.floats(0.01, 0.1), seed=st.integers(0, 2**16))
def test_a_uniform_turn_leaves_the_centripetal_phase_only(turn_rad, seed):
    found = phase(turning(turn_rad * np.linspace(-0.5, 0.5, PULSES), seed))
    assert found.centripetal_rad == pytest.approx(TO_PHASE * turn_rad**2 / 8, rel=2e-3)
    assert max(found.uneven_rad, found.bending_rad) < 1e-6


@given(share=st.floats(-0.3, 0.3), seed=st.integers(0, 2**16))
def test_an_uneven_turn_leaves_its_acceleration(share, seed):
    place = np.linspace(-1, 1, PULSES)
    found = phase(turning(0.03 * (place + share * place**2), seed))
    assert found.uneven_rad == pytest.approx(TO_PHASE * 0.03 * abs(share), rel=0.02, abs=0.05)
    assert found.bending_rad < 1e-6


@given(elevation_rad=st.floats(-1.3, 1.3), turn_rad=st.floats(0.01, 0.08))
def test_linear_angles_meet_the_papers_criterion_but_bend_out_of_the_plane(elevation_rad, turn_rad):
    """A circle of constant θ: its curvature on the sphere is tan θ."""
    azimuth = turn_rad / np.cos(elevation_rad) * np.linspace(-0.5, 0.5, PULSES)
    track = track_from_angles(np.arange(PULSES), np.full(PULSES, elevation_rad), azimuth)
    found = phase(track)
    assert found.angles_rad < 1e-6
    wanted = TO_PHASE * turn_rad**2 / 8 * abs(np.tan(elevation_rad))
    assert found.bending_rad == pytest.approx(wanted, rel=0.05, abs=1e-3)


@settings(max_examples=30)
@given(off_rad=st.floats(0.02, 0.12))
def test_the_papers_angles_bend_at_the_zenith_where_the_line_of_sight_does_not(off_rad):
    """A great circle that passes the pole at a small angle: θ̈ = φ̇² sin θ cos θ ≈ ω² / tan(off)."""
    turn = 0.01 * np.linspace(-0.5, 0.5, PULSES)
    line_of_sight = (
        np.outer(np.sin(turn), [1.0, 0, 0])
        + np.outer(np.cos(turn), [0, np.sin(off_rad), -np.cos(off_rad)])
    )  # fmt: skip
    rate = np.gradient(line_of_sight, axis=0, edge_order=2)
    rate -= line_of_sight * np.sum(line_of_sight * rate, axis=1, keepdims=True)
    found = phase(
        LineOfSightTrack(
            time_s=np.arange(PULSES), line_of_sight=line_of_sight, line_of_sight_rate_per_s=rate
        )
    )
    assert found.near_zenith
    assert found.angles_rad == pytest.approx(TO_PHASE * 0.01**2 / 8 / np.tan(off_rad), rel=0.15)
    assert found.bending_rad < 1e-6


def test_the_bending_phase_is_what_an_image_former_meets():
    """A scatterer above the plane keeps this phase after its plane's own is taken out."""
    azimuth = 0.09 * np.linspace(-0.5, 0.5, PULSES)
    track = track_from_angles(np.arange(PULSES), np.full(PULSES, -0.8), azimuth)
    middle = PULSES // 2
    along = track.line_of_sight[middle]
    across = track.line_of_sight_rate_per_s[middle]
    normal = np.cross(along, across / np.linalg.norm(across))
    height = track.line_of_sight @ normal
    left_rad = TO_PHASE * np.ptp(height - np.polyval(np.polyfit(azimuth, height, 1), azimuth))
    assert phase(track).bending_rad == pytest.approx(left_rad, rel=0.05)
