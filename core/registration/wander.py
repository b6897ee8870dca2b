"""How offsets wander from frame to frame: what an analyst sees of the tracking's errors."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats, frozen


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Wander:
    """Offsets of the frames that were registered.

    Attributes:
        frame_numbers: (frames,) growing.
        offsets_px: (frames, 2) in range rows and cross-range columns.
    """

    frame_numbers: NDArray[np.int64]
    offsets_px: Floats

    def __post_init__(self) -> None:
        numbers = frozen(self.frame_numbers, np.int64, (None,), "Frame numbers")
        offsets = frozen(self.offsets_px, np.float64, (len(numbers), 2), "Offsets")
        object.__setattr__(self, "frame_numbers", numbers)
        object.__setattr__(self, "offsets_px", offsets)

    @property
    def drift_px_per_frame(self) -> Floats:
        """(2,) median step from one frame to the next, which jumps do not move."""
        if len(self.frame_numbers) < 2:
            return np.zeros(2)
        steps = np.diff(self.offsets_px, axis=0) / np.diff(self.frame_numbers)[:, None]
        return np.asarray(np.median(steps, axis=0), dtype=np.float64)

    @property
    def jumps_px(self) -> Floats:
        """(frames,) how far each frame stands from where drift puts it after the one before it."""
        expected = np.diff(self.frame_numbers)[:, None] * self.drift_px_per_frame
        steps = np.diff(self.offsets_px, axis=0) - expected
        jumps: Floats = np.concatenate([[0.0], np.linalg.norm(steps, axis=1)])
        return jumps[: len(self.frame_numbers)]

    def sentence(self) -> str:
        """Return what a person wants to know of it."""
        if len(self.frame_numbers) == 0:
            return "No frame was registered."
        row, column = self.drift_px_per_frame
        high, wide = np.abs(self.offsets_px).max(axis=0)
        largest = int(np.argmax(self.jumps_px))
        return (
            f"Offsets reach {high:.1f} px in range and {wide:.1f} px in cross-range; they drift by "
            f"{row:+.2f} and {column:+.2f} px a frame, and jump by {self.jumps_px[largest]:.1f} px "
            f"at most, at frame {self.frame_numbers[largest]}."
        )
