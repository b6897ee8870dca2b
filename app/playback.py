"""When the next frame may appear: play, pause, step and speed, without threads or servers."""

import time
from collections.abc import Callable
from math import inf, isfinite

SPEEDS_HZ: tuple[float | None, ...] = (1.0, 2.0, 5.0, None)
"""Frames per second that the page offers; None is as fast as they are computed."""

DEFAULT_SPEED_HZ = 5.0


class Playback:
    """Decides when a frame that is ready may be released.

    Not safe to share between threads without a lock of the owner's.
    """

    def __init__(
        self,
        *,
        speed_hz: float | None = DEFAULT_SPEED_HZ,
        is_playing: bool = True,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Start playing at `speed_hz` frames per second, or as fast as they come for None."""
        self.is_playing = is_playing
        self.speed_hz = checked_speed(speed_hz)
        self._steps_owed = 0
        self._released_s = -inf
        self._clock = clock

    def play(self) -> None:
        """Release frames one after the other at the set speed."""
        self.is_playing = True
        self._steps_owed = 0

    def pause(self) -> None:
        """Hold every frame back until someone plays or steps."""
        self.is_playing = False
        self._steps_owed = 0

    def step(self) -> None:
        """Pause, and release one frame as soon as there is one."""
        self._steps_owed = 1 if self.is_playing else self._steps_owed + 1
        self.is_playing = False

    def restart(self) -> None:
        """Forget when the last frame was released and play."""
        self.play()
        self._released_s = -inf

    def set_speed(self, speed_hz: float | None) -> None:
        """Change the frames per second; None is as fast as they come."""
        self.speed_hz = checked_speed(speed_hz)

    def wait_s(self) -> float | None:
        """Return how long to hold the next frame back: 0 for not at all, None until told."""
        if self._steps_owed > 0:
            return 0.0
        if not self.is_playing:
            return None
        if self.speed_hz is None:
            return 0.0
        return max(0.0, self._released_s + 1 / self.speed_hz - self._clock())

    def mark_released(self) -> None:
        """Note that a frame has just been released."""
        self._steps_owed = max(0, self._steps_owed - 1)
        self._released_s = self._clock()


def checked_speed(speed_hz: float | None) -> float | None:
    """Return the speed if frames can be played at it.

    Raises:
        ValueError: not a number between 0.05 and 100 frames per second.
    """
    if speed_hz is not None and not (isfinite(speed_hz) and 0.05 <= speed_hz <= 100):
        raise ValueError(
            "The speed must lie between 0.05 and 100 frames per second, or be null for as fast "
            f"as they are computed; got {speed_hz:g}."
        )
    return speed_hz
