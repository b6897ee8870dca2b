from itertools import islice

import numpy as np

from core.experiments.demo import DEMO_PASSES, FRAMES_PER_PASS, demo_frames, demo_intervals
from core.radar.waveform import Waveform


def test_the_demo_has_three_passes_of_twenty_frames_of_one_resolution():
    intervals = demo_intervals(Waveform())
    numbers = [number for number, _, _ in intervals]
    assert numbers == sorted(numbers)
    assert [numbers.count(number) for number in (1, 2, 3)] == [FRAMES_PER_PASS] * len(DEMO_PASSES)
    turns = np.array([interval.turn_rad for _, _, interval in intervals])
    assert np.abs(Waveform().wavelength_m / (2 * turns) - 0.15).max() < 0.15 * 0.01


def test_the_same_frames_come_every_time():
    first, again = (next(iter(demo_frames(scatterers=500))) for _ in range(2))
    assert np.array_equal(first.amplitude, again.amplitude)


def test_frames_name_their_pass_and_show_something():
    for frame in islice(demo_frames(scatterers=3000), 2):
        assert frame.label == "pass 1"
        assert frame.decibels().min() < -30
