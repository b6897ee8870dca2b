"""Passes over time and their intervals as the JSON that the page and other programs read."""

from typing import Any

import numpy as np

from core.arrays import Floats
from core.frame import Frame
from core.geometry.track import angles_from_line_of_sight
from core.radar.course import CourseInterval, PassCourse
from core.radar.focus import FocusCriterion

_CRITERIA: dict[FocusCriterion, str] = {
    "angles": "by θ̈ and φ̈, the paper's criterion",
    "bending": "by what leaving the image plane makes, which no image former takes out",
    "motion": "by all of the line of sight's second derivative",
}

_CAUSES: dict[FocusCriterion, str] = {
    "angles": "The viewing angles change unevenly during this turn",
    "bending": "The line of sight leaves one plane during this turn",
    "motion": "The line of sight does not turn evenly in one plane here",
}


def interval_facts(frame: Frame, course: tuple[PassCourse, ...]) -> dict[str, Any] | None:
    """Return the interval that a frame is the image of, None where it is not known."""
    if frame.sensor != "radar":
        return None
    found = next((each for each in course if each.label == frame.label), None)
    interval = None if found is None else found.interval_at(frame.time_s)
    if found is None or interval is None:
        return None
    return {
        "verdict": interval.assessed.verdict.status,
        "reason": interval.assessed.verdict.reason,
        "in_words": _in_words(found, interval),
        "start_s": interval.imaged_start_s,
        "stop_s": interval.imaged_stop_s,
        "turn_deg": float(np.degrees(interval.imaged.turn_rad)),
        "pulses": interval.imaged.stop - interval.imaged.start,
    }


def pass_facts(course: PassCourse) -> dict[str, Any]:
    """Return a pass over time, thinned out to be drawn, with all of its intervals."""
    theta_rad, phi_rad = angles_from_line_of_sight(course.line_of_sight)
    return {
        "label": course.label,
        "epoch_utc": course.epoch_utc,
        "judged": _judged(course),
        "time_s": _rounded(course.time_s, 3),
        "azimuth_deg": _compass_degrees(course.azimuth_rad),
        "elevation_deg": _degrees(course.elevation_rad),
        "theta_deg": _degrees(theta_rad),
        "phi_deg": _degrees(phi_rad),
        "rotation_rate_deg_s": _rounded(np.degrees(course.rotation_rate_rad_per_s), 6),
        "resolution_m": _rounded(course.resolution_m, 4),
        "intervals": [_interval_facts(each) for each in course.intervals],
    }


def _interval_facts(interval: CourseInterval) -> dict[str, Any]:
    wanted, verdict = interval.assessed.wanted, interval.assessed.verdict
    return {
        "start_s": interval.start_s,
        "stop_s": interval.stop_s,
        "middle_s": interval.middle_s,
        "verdict": verdict.status,
        "reason": verdict.reason,
        "resolution_m": float(verdict.resolution_m),
        "turn_deg": float(np.degrees(wanted.turn_rad)),
        "pulses": wanted.stop - wanted.start,
    }


def _in_words(course: PassCourse, interval: CourseInterval) -> str:
    """Return what is wrong with an interval for people who use its image, empty if nothing is."""
    verdict, division = interval.assessed.verdict, course.division
    if verdict.status == "accepted" or division is None or division.target_radius_m is None:
        return ""
    sharp = f"a sharp image would resolve {verdict.resolution_m:.2g} m"
    end = {
        "shortened": f"Only its middle is imaged, which resolves {verdict.resolution_m:.2g} m",
        "rejected": f"It gives no sharp image; {sharp}",
    }[verdict.status]
    if course.images_whole:
        end = f"It is imaged whole all the same; {sharp}"
    return (
        f"{_CAUSES[division.criterion]}, which blurs what lies {division.target_radius_m:.3g} m "
        f"from the middle. {end}."
    )


def _judged(course: PassCourse) -> str:
    """Return what the verdicts mean, empty where nothing was judged."""
    division = course.division
    if division is None or division.target_radius_m is None:
        return ""
    sentence = (
        f"Judged for {division.target_radius_m:.3g} m about the origin, "
        f"{_CRITERIA[division.criterion]}."
    )
    return f"{sentence} All are imaged whole." if course.images_whole else sentence


def _compass_degrees(azimuth_rad: Floats | None) -> list[float | None] | None:
    """Return 0° to 360°; a track may go on counting beyond north."""
    return None if azimuth_rad is None else _degrees(np.mod(azimuth_rad, 2 * np.pi))


def _degrees(angle_rad: Floats | None) -> list[float | None] | None:
    return None if angle_rad is None else _rounded(np.degrees(angle_rad), 4)


def _rounded(values: Floats, decimals: int) -> list[float | None]:
    """Return numbers as JSON has them: NaN is null."""
    return [round(value, decimals) if np.isfinite(value) else None for value in map(float, values)]
