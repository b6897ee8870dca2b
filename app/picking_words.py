"""What a page that picks is told, and what its measurements are called."""

from collections.abc import Collection, Mapping

from app.picking import EXTREME_SHARE, Kind, Picking, Snap, hull_size_m
from core.hull.closed_mesh import Surface

STEMS: Mapping[Kind, str] = {
    "length": "length",
    "polyline": "polyline",
    "line feature": "l",
    "plane normal": "plane",
    "cylinder axis": "cylinder",
    "principal axes": "axes",
    "section": "section",
}
"""What measurements of each kind are called, before a number."""

_SUBSCRIPTS = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")


def free_line_name(taken: Collection[str]) -> str:
    """Return the first of l₁, l₂ … that no measurement has, as the paper calls line features."""
    names = (f"l{number}".translate(_SUBSCRIPTS) for number in range(1, len(taken) + 2))
    return next(name for name in names if name not in taken)


def hint_of(picking: Picking, surface: Surface | None) -> str:
    """Return what to do next, in a sentence."""
    snap_words = _snap_words(picking.snap, surface) if picking.is_at_point else ""
    return f"{picking.kind.capitalize()}: {_next_step(picking)}{snap_words}"


def _next_step(picking: Picking) -> str:
    count = len(picking.picks)
    if picking.kind == "polyline":
        return "click the first point" if count == 0 else "click the next point, Enter ends it"
    if picking.kind in ("length", "line feature"):
        return f"click the {'first' if count == 0 else 'second'} end"
    return {
        "plane normal": "click a flat face",
        "cylinder axis": "click a round side",
        "principal axes": "click a part",
        "section": "click a point; it cuts across the part's longest axis",
    }[picking.kind]


def _snap_words(snap: Snap, surface: Surface | None) -> str:
    if snap == "surface":
        return ""
    if snap == "part end":
        return ", at a part's end"
    within = "" if surface is None or surface.is_empty else hull_size_m(surface) * EXTREME_SHARE
    return f", farthest out within {within:.1f} m" if within else ", farthest out"
