"""What the curves of accuracy say, in words."""

from collections.abc import Mapping

from core.experiments.accuracy_conditions import Condition
from core.experiments.accuracy_curves import Curve

GOOD_PERCENT = 2.0
"""Mean error of lengths up to which a hull counts as good to measure."""


def noise_finding(curves: Mapping[str, Curve], centre: Condition) -> str:
    """Return what was found at the centre and along every curve.

    Args:
        curves: by the field of `Condition` that runs.
        centre: where they meet.
    """
    return (
        f"At {centre.frames} frames of {centre.resolution_m:g} m and "
        f"{curves['signal_to_noise_db'].named(centre.signal_to_noise_db)}, "
        f"{_told(curves['frames'], centre.frames)}; "
        + "; ".join(
            f"{curve.factor}: {_reach(curve)} ({_extremes(curve)})" for curve in curves.values()
        )
        + "."
        + _too_clear(curves["signal_to_noise_db"])
    )


def _too_clear(curve: Curve) -> str:
    """Return why more signal may not help, empty if it does."""
    errors = {
        level: curve.mean(level, "mean length error") for level in (curve.centre, max(curve.found))
    }
    centre, clearest = errors[curve.centre], errors[max(curve.found)]
    if centre is None or clearest is None or clearest <= 1.5 * centre:
        return ""
    return (
        f" {curve.named(max(curve.found))} is worse than {curve.named(curve.centre)}: there the "
        "detector's threshold sinks below the sidelobes, whose ceiling then sets the edge, but "
        "the point spread is taken out as if the threshold had set it, which is too much."
    )


def _reach(curve: Curve) -> str:
    """Return for which values of a factor lengths are good."""
    errors = {value: curve.mean(value, "mean length error") for value in curve.found}
    good = [value for value, error in errors.items() if error is not None and error <= GOOD_PERCENT]
    if not good:
        return f"nowhere lengths within {GOOD_PERCENT:g} %"
    reach = " to ".join(dict.fromkeys(curve.named(value) for value in (min(good), max(good))))
    return f"lengths within {GOOD_PERCENT:g} % on average at {reach}"


def _extremes(curve: Curve) -> str:
    first, last = min(curve.found), max(curve.found)
    return ", ".join(
        f"at {curve.named(value)} {_told(curve, value)}" for value in dict.fromkeys((first, last))
    )


def _told(curve: Curve, value: float) -> str:
    agreement, length, angle = (
        curve.mean(value, measure)
        for measure in ("IoU", "mean length error", "mean attitude error")
    )
    lines = (
        "its lines are lost"
        if length is None or angle is None
        else f"lines err by {length:.1f} % and {angle:.1f}°"
    )
    return f"IoU is {agreement:.3f}, {lines}"
