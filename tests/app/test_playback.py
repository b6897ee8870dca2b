import math

import pytest

from app.playback import Playback


class Clock:
    def __init__(self) -> None:
        self.now_s = 100.0

    def __call__(self) -> float:
        return self.now_s


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def playback(clock: Clock) -> Playback:
    return Playback(speed_hz=2.0, clock=clock)


def test_first_frame_appears_at_once(playback: Playback) -> None:
    assert playback.wait_s() == 0


def test_frames_appear_at_the_set_speed(playback: Playback, clock: Clock) -> None:
    playback.mark_released()
    assert playback.wait_s() == pytest.approx(0.5)
    clock.now_s += 0.2
    assert playback.wait_s() == pytest.approx(0.3)
    clock.now_s += 0.4
    assert playback.wait_s() == 0


def test_without_a_speed_frames_appear_as_they_come(playback: Playback) -> None:
    playback.set_speed(None)
    playback.mark_released()
    assert playback.wait_s() == 0


def test_paused_frames_wait_until_told(playback: Playback) -> None:
    playback.pause()
    assert playback.wait_s() is None
    playback.play()
    assert playback.wait_s() == 0


def test_step_pauses_and_lets_exactly_one_frame_through(playback: Playback) -> None:
    playback.step()
    assert not playback.is_playing
    assert playback.wait_s() == 0
    playback.mark_released()
    assert playback.wait_s() is None


def test_steps_add_up_while_paused_and_are_forgotten_by_pause(playback: Playback) -> None:
    playback.pause()
    playback.step()
    playback.step()
    playback.mark_released()
    assert playback.wait_s() == 0
    playback.pause()
    assert playback.wait_s() is None


def test_restart_plays_without_waiting(playback: Playback) -> None:
    playback.mark_released()
    playback.pause()
    playback.restart()
    assert playback.is_playing
    assert playback.wait_s() == 0


@pytest.mark.parametrize("speed_hz", [0.0, -1.0, math.nan, math.inf, 1000.0])
def test_impossible_speeds_are_refused_with_the_range(playback: Playback, speed_hz: float) -> None:
    with pytest.raises(ValueError, match=r"between 0\.05 and 100 frames per second"):
        playback.set_speed(speed_hz)
    assert playback.speed_hz == 2.0
