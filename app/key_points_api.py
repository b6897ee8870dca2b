"""The JSON interface to key points: marks, names, the way back, and lengths between them."""

from collections.abc import Callable
from typing import Annotated, Any

from fastapi import APIRouter, Depends
from pydantic import Field
from starlette.requests import HTTPConnection

from app.api import Stream, record_at
from app.editing_api import Body, refusing
from app.key_point_facts import expectation_facts, key_point_facts, length_facts
from app.key_points import KeyPoints
from app.measuring import MeasurementDesk
from core.analysis.key_point_marks import KeyPointBook, checked_name
from core.analysis.key_point_places import expectations
from core.analysis.measurement_book import MeasurementBook
from core.measurement.key_point_errors import key_points_of, with_key_point_renamed
from core.measurement.key_points import KeyPoint, length_between

router = APIRouter(prefix="/api/key_points")

HALF_DIAGONAL = 0.5 * 3**0.5
"""Of a cube, in its sides: no corner of a target in the window lies farther from its middle."""


def _key_points(connection: HTTPConnection) -> KeyPoints:
    points: KeyPoints = connection.app.state.key_points
    return points


def _desk(connection: HTTPConnection) -> MeasurementDesk:
    desk: MeasurementDesk = connection.app.state.desk
    return desk


Points = Annotated[KeyPoints, Depends(_key_points)]
Desk = Annotated[MeasurementDesk, Depends(_desk)]


class MarkOrder(Body):
    """Where a corner is seen in a frame."""

    name: str = Field(max_length=400, description="Of the key point; a new one begins a point.")
    frame: int
    row: float
    column: float


class NameOrder(Body):
    """Another name for a key point."""

    name: str
    new_name: str = Field(max_length=400)


class SigmaOrder(Body):
    """How exactly corners are marked."""

    sigma_px: float = Field(description="Standard deviation of a mark's row or column.")


@router.get("")
def read_key_points(points: Points) -> dict[str, Any]:
    """Return all key points with their marks, places and residuals."""
    return key_point_facts(points.state)


@router.get("/expected/{number}")
def read_expected(number: int, points: Points, stream: Stream) -> dict[str, Any]:
    """Return where each key point should be seen in a frame, or on which lines."""
    record_at(stream, number)
    state, side_m = points.state, stream.snapshot.settings.side_m
    if number not in state.projections:  # it has come since
        return {"revision": state.book.revision, "expected": []}
    found = expectations(state.points, number, state.projections, reach_m=HALF_DIAGONAL * side_m)
    return {
        "revision": state.book.revision,
        "expected": [expectation_facts(expected) for expected in found],
    }


@router.get("/length")
def read_length(first: str, second: str, points: Points) -> dict[str, Any]:
    """Return the length between two key points with its 95 % interval."""
    with refusing():
        return length_facts(length_between(_placed(first, points), _placed(second, points)))


@router.put("/mark")
def put_mark(order: MarkOrder, points: Points, stream: Stream) -> dict[str, Any]:
    """Mark a key point in a frame, for the first time or anew."""
    rows, columns = record_at(stream, order.frame).frame.shape
    with refusing():
        if not (-0.5 <= order.row <= rows - 0.5 and -0.5 <= order.column <= columns - 0.5):
            raise ValueError(
                f"Frame {order.frame} has {rows} × {columns} pixels; a mark at row "
                f"{order.row:.1f}, column {order.column:.1f} lies outside. Mark a corner in it."
            )
        place = (order.row, order.column)
        return _changed(points, lambda book: book.marked(order.name, order.frame, place))


@router.delete("/mark")
def delete_mark(name: str, frame: int, points: Points) -> dict[str, Any]:
    """Take a key point's mark in a frame away; the point goes with its last mark."""
    return _changed(points, lambda book: book.without_mark(name, frame))


@router.delete("/point")
def delete_point(name: str, points: Points) -> dict[str, Any]:
    """Take a key point away with all its marks."""
    return _changed(points, lambda book: book.without(name))


@router.put("/name")
def put_name(order: NameOrder, points: Points, desk: Desk) -> dict[str, Any]:
    """Give a key point another name, also where measurements refer to it."""
    facts = _changed(points, lambda book: book.renamed(order.name, order.new_name))
    if any(order.name in key_points_of(spec) for spec in desk.book.specs):
        desk.turn(lambda book: _following(book, order.name, checked_name(order.new_name)))
    return facts


@router.put("/sigma")
def put_sigma(order: SigmaOrder, points: Points) -> dict[str, Any]:
    """Say how exactly corners are marked; standard errors and doubts about marks follow."""
    return _changed(points, lambda book: book.with_sigma_px(order.sigma_px))


@router.post("/undo")
def undo(points: Points) -> dict[str, Any]:
    """Take the last change of key points back."""
    return _changed(points, KeyPointBook.undone)


@router.post("/redo")
def redo(points: Points) -> dict[str, Any]:
    """Make the change again that was taken back last."""
    return _changed(points, KeyPointBook.redone)


def _following(book: MeasurementBook, name: str, new_name: str) -> MeasurementBook:
    """Return the book of measurements with a key point called otherwise, as one step."""
    followed = book
    for spec in book.specs:
        if name in key_points_of(spec):
            followed = followed.replaced(spec.name, with_key_point_renamed(spec, name, new_name))
    return book.then(followed)


def _changed(
    points: KeyPoints, operation: Callable[[KeyPointBook], KeyPointBook]
) -> dict[str, Any]:
    with refusing():
        return key_point_facts(points.change(operation))


def _placed(name: str, points: KeyPoints) -> KeyPoint:
    found = next((point for point in points.state.points if point.name == name), None)
    if found is None:
        raise ValueError(f'There is no key point "{name}"; mark it in two or more frames.')
    if found.place is None:
        raise ValueError(found.complaint)
    return found.place
