"""Key points as the JSON that the page and other programs read."""

from typing import Any

from app.key_points import KeyPointState
from core.analysis.key_point_places import Expectation, Mark, PlacedPoint
from core.arrays import Floats
from core.measurement.key_points import KeyPointLength


def key_point_facts(state: KeyPointState) -> dict[str, Any]:
    """Return what the state of the workstation tells of key points, under its names there."""
    return {"key_points": point_facts(state), "key_points_book": book_facts(state)}


def point_facts(state: KeyPointState) -> list[dict[str, Any]]:
    """Return the points with their marks, places and residuals."""
    return [_point_facts(point) for point in state.points]


def book_facts(state: KeyPointState) -> dict[str, Any]:
    """Return what is known of the book of marks as a whole."""
    book = state.book
    return {
        "revision": book.revision,
        "can_undo": book.can_undo,
        "can_redo": book.can_redo,
        "sigma_px": book.sigma_px,
    }


def expectation_facts(expected: Expectation) -> dict[str, Any]:
    """Return where a point should be seen in a frame, as (row, column)."""
    return {
        "name": expected.name,
        "place": _listed(expected.place),
        "lines": [line.tolist() for line in expected.lines],
    }


def length_facts(length: KeyPointLength) -> dict[str, Any]:
    """Return a length between two key points with its 95 % interval, in metres."""
    return {
        "value_m": length.value_m,
        "low_m": length.low_m,
        "high_m": length.high_m,
        "standard_error_m": length.standard_error_m,
        "direction": _listed(length.direction),
    }


def _point_facts(point: PlacedPoint) -> dict[str, Any]:
    return {
        "name": point.name,
        "position_m": None if point.place is None else _listed(point.place.position_m),
        "sigma_m": _listed(point.standard_errors_m),
        "marks": [_mark_facts(mark) for mark in point.marks],
        "complaint": point.complaint,
    }


def _mark_facts(mark: Mark) -> dict[str, Any]:
    return {
        "frame": mark.frame,
        "row": mark.row,
        "column": mark.column,
        "residual_px": mark.residual_px,
        "is_suspicious": mark.is_suspicious,
    }


def _listed(values: Floats | None) -> list[float] | None:
    return None if values is None else [float(value) for value in values]
