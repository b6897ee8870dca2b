"""Pictures of the experiment on passes and stations."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure as Canvas

from core.experiments.arcs import Arc
from core.experiments.frame_pictures import OutlinedFrame, frames_picture
from core.experiments.hull_pictures import error_pictures, sides_picture
from core.experiments.observability_picture import observability_picture
from core.experiments.passes_results import Candidate, Seen, extent_error_percent, rank_correlations
from core.experiments.pictures import Picture
from core.targets import Target

ECHOES, TRUE, TRUTH = "#58b4ff", "#e6b450", "#7fd48a"


def passes_pictures(
    seen: Seen,
    frames: Sequence[OutlinedFrame],
    arcs: Mapping[str, Sequence[Arc]],
    target: Target,
) -> tuple[Picture, ...]:
    """Return all pictures of the experiment.

    Args:
        seen: what was observed.
        frames: of the passes over one station.
        arcs: by the title of the sky plot that shows them.
        target: the truth.
    """
    name, most = list(seen.growth.items())[-1]
    return (
        _growth_picture(seen),
        _stations_picture(seen),
        _sky_picture(arcs),
        _prediction_picture(seen.candidates),
        frames_picture(
            frames,
            target,
            name="passes-frames",
            caption="Radar frames of the passes over Beijing with the outlines found and the true "
            "ones: range down, cross-range right, 45 dB of amplitude.",
        ),
        sides_picture(most.echoes.surface, target, name="passes-hull", what=f"Hull of {name}"),
        *error_pictures(most.echoes.surface, target, name="passes-errors"),
        observability_picture(
            {title: each.views for title, each in list(seen.growth.items())[:3]},
            name="passes-directions",
        ),
    )


def _growth_picture(seen: Seen) -> Picture:
    hulls = list(seen.growth.values())
    counts = [int(title.split()[0]) for title in seen.growth]

    def draw(canvas: Canvas) -> None:
        volume, share, lengths = canvas.subplots(1, 3)
        for title, colour, found in (
            ("echoes", ECHOES, [each.echoes for each in hulls]),
            ("true outlines", TRUE, [each.true for each in hulls]),
        ):
            volumes = [hull.volume_m3 for hull in found]
            volume.plot(counts, volumes, "o-", color=colour, label=title)
            ious = [hull.agreement.intersection_over_union for hull in found]
            share.plot(counts, ious, "o-", color=colour, label=f"IoU, {title}")
        volume.axhline(seen.true_m3, color=TRUTH, linestyle=":", label="truth")
        volume.set(yscale="log", ylabel="volume (m³)")
        coverage = [each.echoes.agreement.coverage for each in hulls]
        unobserved = [each.unobserved_percent / 100 for each in hulls]
        share.plot(counts, coverage, "s--", color=ECHOES, label="coverage, echoes")
        share.plot(counts, unobserved, "^--", color="#ff6b6b", label="directions unobserved")
        share.set(ylim=(-0.03, 1.03))
        for axis, true_m in enumerate(seen.true_extents_m):
            errors = [extent_error_percent(each.echoes, axis, true_m) for each in hulls]
            drawn = [np.nan if error is None else error for error in errors]
            lengths.plot(counts, drawn, "o-", label=f"{'xyz'[axis]}, {true_m:.2f} m")
        lengths.set(yscale="symlog", ylabel="error of the extent, echoes (%)")
        for cell in (volume, share, lengths):
            cell.set(xscale="log", xlabel="passes over Beijing")
            cell.set_xticks(counts, [str(count) for count in counts])
            cell.minorticks_off()
            cell.legend()

    return Picture(
        name="passes-growth",
        caption="How the hull comes down to its body with more passes of one station. An extent "
        "that is not bounded has no error and is left out.",
        draw=draw,
        size_in=(13.0, 4.2),
    )


def _stations_picture(seen: Seen) -> Picture:
    names, hulls = list(seen.together), list(seen.together.values())

    def draw(canvas: Canvas) -> None:
        volume, iou = canvas.subplots(1, 2, sharey=True)
        for cell in (volume, iou):
            cell.set_axisbelow(True)
        places = np.arange(len(names))
        for shift, title, colour, found in (
            (-0.2, "echoes", ECHOES, [each.echoes for each in hulls]),
            (0.2, "true outlines", TRUE, [each.true for each in hulls]),
        ):
            style = {"height": 0.38, "color": colour, "label": title}
            volume.barh(places + shift, [hull.volume_m3 for hull in found], **style)
            ious = [hull.agreement.intersection_over_union for hull in found]
            iou.barh(places + shift, ious, **style)
        volume.axvline(seen.true_m3, color=TRUTH, linestyle=":", label="truth")
        volume.set(xscale="log", xlabel="volume (m³)")
        volume.set_yticks(places, names)
        volume.invert_yaxis()
        iou.set(xlabel="IoU", xlim=(0, 1))
        iou.legend()

    least, most = seen.bistatic_deg
    return Picture(
        name="passes-stations",
        caption="One pass seen by one, two and three stations, and by the bistatic pair of "
        f"Beijing (transmits) and Shanghai (receives), whose angle runs from {least:.0f} to "
        f"{most:.0f}°. The dotted line is the true volume.",
        draw=draw,
        size_in=(11.0, 4.0),
    )


def _sky_picture(arcs: Mapping[str, Sequence[Arc]]) -> Picture:
    def draw(canvas: Canvas) -> None:
        cells = canvas.subplots(1, len(arcs), subplot_kw={"projection": "polar"}, squeeze=False)[0]
        for cell, (title, shown) in zip(cells, arcs.items(), strict=True):
            for arc in shown:
                k = arc.track.line_of_sight[[each.middle for each in arc.intervals]]
                # From ahead (x) at the top through starboard (y) at the right, as seen from below.
                angle, tilt = np.arctan2(k[:, 1], k[:, 0]), np.rad2deg(np.arccos(-k[:, 2]))
                cell.plot(angle, tilt, ".-", linewidth=0.8, label=arc.label)
            cell.set_theta_zero_location("N")
            cell.set_theta_direction(-1)
            cell.set_rlim(0, 75)
            cell.set_rgrids([20, 40, 60], labels=["20°", "40°", "60°"])
            cell.set_thetagrids([0, 90, 180, 270], labels=["+x", "+y", "−x", "−y"])
            cell.set_title(title)
            cell.legend(loc="center left", bbox_to_anchor=(1.06, 0.5))

    return Picture(
        name="passes-lines-of-sight",
        caption="Lines of sight in the target frame, one dot for each frame: the centre is "
        "straight up from the ground, circles are degrees from there. Of the pair it is the "
        "bisector.",
        draw=draw,
        size_in=(6.0 * len(arcs), 4.6),
    )


def _prediction_picture(candidates: Mapping[int, Sequence[Candidate]]) -> Picture:
    def draw(canvas: Canvas) -> None:
        cells = canvas.subplots(1, len(candidates), squeeze=False)[0]
        for cell, (count, shown) in zip(cells, candidates.items(), strict=True):
            predicted = [each.predicted_m3 for each in shown]
            confirmed = [each.confirmed_m3 for each in shown]
            cell.plot(predicted, confirmed, "o", color=ECHOES)
            for number, each in enumerate(sorted(shown, key=lambda each: each.predicted_m3)):
                cell.annotate(
                    each.label.split(":")[0],
                    (each.predicted_m3, each.confirmed_m3),
                    xytext=(6, 3) if number % 2 else (6, -11),
                    textcoords="offset points",
                    fontsize=8,
                )
            positive = [value for value in (*predicted, *confirmed) if value > 0]
            ends = [0.7 * min(positive, default=1.0), 1.4 * max(positive, default=1.0)]
            cell.plot(ends, ends, ":", color=TRUTH, label="as predicted")
            rank = rank_correlations(shown)[0]
            cell.set(
                xscale="log", yscale="log", title=f"after {count}, rank correlation {rank:.2f}"
            )
            cell.set(xlabel="expected carving (m³)", ylabel="carved by its echoes (m³)")
            cell.legend(loc="upper left")

    return Picture(
        name="passes-prediction",
        caption="The next pass, by its number: what it is expected to carve, from the present "
        "hull and its lines of sight, and what its echoes then carved. Above the dotted line more "
        "came than was expected.",
        draw=draw,
        size_in=(5.6 * len(candidates), 4.6),
    )
