import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from core.geometry.track import random_views_track
from core.radar.echoes import point_echoes, receiver_noise, simulate_echoes
from core.radar.scatterers import surface_scatterers
from core.radar.waveform import SPEED_OF_LIGHT_M_PER_S, Waveform
from core.targets import Target

WAVEFORM = Waveform(frequency_count=64)


def burst(seed=0, pulses=16):
    return random_views_track(
        views=1,
        turn_rad=0.06,
        pulses_per_view=pulses,
        pulse_repetition_frequency_hz=100.0,
        random=np.random.default_rng(seed),
    )


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), count=st.integers(1, 40))
def test_the_transform_equals_the_direct_sum(seed, count):
    random = np.random.default_rng(seed)
    position = random.uniform(-6, 6, (count, 3))
    amplitude = random.normal(size=count) + 1j * random.normal(size=count)
    line_of_sight = burst(seed).line_of_sight
    frequency = WAVEFORM.frequencies_hz()
    ranges = line_of_sight @ position.T
    phase = 4 * np.pi / SPEED_OF_LIGHT_M_PER_S * frequency[None, :, None] * ranges[:, None, :]
    direct = np.exp(-1j * phase) @ amplitude
    fast = point_echoes(position, amplitude, line_of_sight, frequency)
    assert np.abs(fast - direct).max() < 1e-3 * np.abs(amplitude).sum()
    assert np.linalg.norm(fast - direct) < 2e-4 * np.linalg.norm(amplitude) * np.sqrt(direct.size)


def test_noise_has_the_stated_power():
    noise = receiver_noise((400, 500), 3.0, np.random.default_rng(1))
    assert np.mean(np.abs(noise) ** 2) == pytest.approx(3.0, rel=0.02)
    assert abs(np.mean(noise)) < 0.02


def test_signal_to_noise_is_mean_echo_power_over_noise_power():
    """Of a sphere, which returns its projected area from everywhere, a quarter of its surface."""
    sphere = Target(name="sphere", parts=(trimesh.creation.icosphere(subdivisions=3, radius=2.0),))
    random = np.random.default_rng(2)
    points = surface_scatterers(sphere, count=20_000, random=random)
    track = burst(pulses=128)
    quiet = simulate_echoes(
        points, track, WAVEFORM, signal_to_noise_db=200.0, random=random
    ).samples
    loud = simulate_echoes(points, track, WAVEFORM, signal_to_noise_db=7.0, random=random).samples
    noise_power = np.mean(np.abs(loud - quiet) ** 2)
    assert points.mean_echo_power() / noise_power == pytest.approx(10**0.7, rel=0.05)
    # Speckle of one realisation scatters by far more than the mean's own error.
    assert np.mean(np.abs(quiet) ** 2) / points.mean_echo_power() == pytest.approx(1, rel=0.6)


def test_a_target_beyond_the_unambiguous_range_is_refused():
    long = Target(name="boom", parts=(trimesh.creation.box((30, 0.1, 0.1)),))
    points = surface_scatterers(long, count=100, random=np.random.default_rng(0))
    with pytest.raises(ValueError, match="unambiguous"):
        simulate_echoes(
            points, burst(), WAVEFORM, signal_to_noise_db=20, random=np.random.default_rng(0)
        )
