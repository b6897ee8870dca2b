"""Pictures of the registration's part: offsets, residuals, drift and jumps, frame by frame."""

import numpy as np
from matplotlib.figure import Figure as Canvas
from numpy.typing import NDArray

from core.arrays import Floats
from core.experiments.pictures import Picture

TRUE, FOUND, CENTROID, BAD = "#8fa3b8", "#4fc3f7", "#ffb74d", "#ef5350"
AXES = ("range", "cross-range")


def offsets_picture(true_px: Floats, left_px: Floats, centroid_left_px: Floats) -> Picture:
    """Return found over true offsets; all arrays (frames, 2), residuals without translation."""

    def draw(canvas: Canvas) -> None:
        for axis, axes in enumerate(canvas.subplots(1, 2, sharey=True)):
            true = true_px[:, axis]
            axes.plot(true, true + centroid_left_px[:, axis], "x", color=CENTROID, label="centroid")
            axes.plot(true, true + left_px[:, axis], "o", ms=4, color=FOUND, label="agreement")
            axes.plot([true.min(), true.max()], [true.min(), true.max()], color=TRUE, lw=1)
            axes.set(title=AXES[axis], xlabel="true offset (px)")
        canvas.axes[0].set_ylabel("found offset (px)")
        canvas.axes[0].legend(loc="upper left")

    return Picture(
        name="registration-offsets",
        caption="Offsets found over offsets put into the echoes, in pixels of 0.06 m, by agreement "
        "of all outlines and by their centroids, after the one free translation.",
        draw=draw,
        size_in=(10.0, 4.8),
    )


def residuals_picture(
    left_px: Floats, centroid_left_px: Floats, spoilt_left_px: Floats, is_spoilt: NDArray[np.bool_]
) -> Picture:
    """Return each frame's residual distance; arrays (frames, 2), and (frames,) which are bad."""
    frames = np.arange(1, len(left_px) + 1)

    def draw(canvas: Canvas) -> None:
        upper, lower = canvas.subplots(2, 1, sharex=True, sharey=True)
        distances = {"centroid": centroid_left_px, "agreement": left_px}
        for (name, left), colour in zip(distances.items(), (CENTROID, FOUND), strict=True):
            upper.plot(frames, np.linalg.norm(left, axis=1), ".-", color=colour, lw=0.8, label=name)
        spoilt = np.linalg.norm(spoilt_left_px, axis=1)
        good = ~is_spoilt
        lower.plot(frames[good], spoilt[good], ".-", color=FOUND, lw=0.8, label="good silhouettes")
        lower.plot(frames[is_spoilt], spoilt[is_spoilt], "x", color=BAD, label="bad silhouettes")
        for axes in (upper, lower):
            axes.axhline(0.5, color=TRUE, lw=1, ls="--")
            axes.set(yscale="log", ylabel="residual (px)")
            axes.legend(loc="upper right", ncols=2)
        upper.set_title("All silhouettes as extracted")
        lower.set(title="A tenth of them cut in half or crossed by a streak", xlabel="frame")

    return Picture(
        name="registration-residuals",
        caption="What registration leaves of each frame's offset, in pixels of 0.06 m; below with "
        "a tenth of the silhouettes spoilt. The dashed line is 0.5 px.",
        draw=draw,
        size_in=(10.0, 6.0),
    )


def passes_picture(
    true_px: Floats, left_px: Floats, is_bad: NDArray[np.bool_], frames_per_pass: int
) -> Picture:
    """Return true and found offsets (frames, 2) of passes that drift and jump."""
    frames = np.arange(1, len(true_px) + 1)

    def draw(canvas: Canvas) -> None:
        for axis, axes in enumerate(canvas.subplots(2, 1, sharex=True)):
            for start in range(0, len(frames), frames_per_pass):
                one = slice(start, start + frames_per_pass)
                label = "true" if start == 0 else None
                axes.plot(frames[one], true_px[one, axis], color=TRUE, label=label)
            found = true_px[:, axis] + left_px[:, axis]
            axes.plot(frames[~is_bad], found[~is_bad], "o", ms=4, color=FOUND, label="found")
            axes.plot(frames[is_bad], found[is_bad], "x", color=BAD, label="found, contradicts")
            axes.set_ylabel(f"{AXES[axis]} offset (px)")
        canvas.axes[0].legend(loc="upper left", ncols=3)
        canvas.axes[0].set_title("Three passes that drift from their start and jump in the middle")
        canvas.axes[1].set_xlabel("frame")

    return Picture(
        name="registration-passes",
        caption="Drift and jumps of the demo's three passes, put in and found, in pixels of "
        "0.06 m. Image planes of one pass nearly coincide and meet along range, so that "
        "cross-range is told less well.",
        draw=draw,
        size_in=(10.0, 5.5),
    )
