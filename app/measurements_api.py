"""The JSON interface for measurements: the book, its way back, its files and its intervals."""

from typing import Annotated, Any, Literal

from fastapi import APIRouter, Depends, HTTPException, Query, Request, Response
from pydantic import Field
from starlette.concurrency import run_in_threadpool
from starlette.requests import ClientDisconnect, HTTPConnection

from app.api import Stream
from app.attitudes import Attitudes
from app.editing_api import Body, refusing
from app.export import file_name
from app.measurement_facts import MeasurementFacts
from app.measurement_files import measurements_file
from app.measuring import MeasurementDesk
from app.source_api import shown_name
from core.analysis.measurement_book import MeasurementBook, Referred
from core.formats.measurement_fields import KINDS
from core.formats.measurements import MAX_BYTES, measurements_from_bytes, spec_from_json
from core.geometry.directions import FrameName
from core.measurement.specs import MAX_NAME, MAX_NOTE, Spec

router = APIRouter(prefix="/api")

MEASURED_WITHIN_S = 1.0
"""How long an answer waits for numbers that are being measured; they come with the state too."""

LEARNED_WITHIN_S = 20.0
"""How long a file waits for the passes to be looked up."""

Name = Annotated[str, Field(max_length=MAX_NAME)]


def _desk(connection: HTTPConnection) -> MeasurementDesk:
    desk: MeasurementDesk = connection.app.state.desk
    return desk


def _facts(connection: HTTPConnection) -> MeasurementFacts:
    facts: MeasurementFacts = connection.app.state.measurement_facts
    return facts


Desk = Annotated[MeasurementDesk, Depends(_desk)]
Facts = Annotated[MeasurementFacts, Depends(_facts)]


class AddOrder(Body):
    """What to measure, as a file of measurements describes it; without a name it gets one."""

    spec: dict[str, Any] | None = None
    specs: list[dict[str, Any]] = Field(default=[], max_length=100, description="All or none.")


class ChangeOrder(Body):
    """What shall be otherwise with a measurement; what is not given stays."""

    name: Name
    rename: Name | None = None
    is_hidden: bool | None = None
    note: str | None = Field(default=None, max_length=MAX_NOTE)
    spec: dict[str, Any] | None = None


class IntervalsOrder(Body):
    """Whether to state intervals now, or to give them up."""

    action: Literal["start", "cancel"]


@router.get("/measurements")
def read_measurements(facts: Facts) -> dict[str, Any]:
    """Return all measurements as they stand."""
    return facts()


@router.post("/measurements")
def add(order: AddOrder, desk: Desk, facts: Facts) -> dict[str, Any]:
    """Measure something more."""
    with refusing():
        values = [*([] if order.spec is None else [order.spec]), *order.specs]
        specs = [_spec(each, desk) for each in values]
        desk.turn(lambda book: book.added(specs))
    return _measured(desk, facts)


@router.put("/measurements")
def change(order: ChangeOrder, desk: Desk, facts: Facts) -> dict[str, Any]:
    """Rename, hide, show, annotate or replace a measurement: all that is asked, or nothing."""
    with refusing():
        spec = None if order.spec is None else _replacing(order.name, order.spec, desk)
        desk.turn(lambda book: _changed(book, order, spec))
    return _measured(desk, facts)


@router.delete("/measurements")
def remove(
    desk: Desk,
    facts: Facts,
    name: Annotated[str, Query(max_length=MAX_NAME)],
    along: Annotated[bool, Query(description="Delete what is computed from it too.")] = False,
) -> dict[str, Any]:
    """Measure something no more."""
    with refusing():
        try:
            desk.remove(name, along=along)
        except Referred as error:
            raise HTTPException(409, str(error)) from error
    return facts()


@router.post("/measurements/undo")
def undo(desk: Desk, facts: Facts) -> dict[str, Any]:
    """Take the last change of the measurements back."""
    with refusing():
        desk.undo()
    return _measured(desk, facts)


@router.post("/measurements/redo")
def redo(desk: Desk, facts: Facts) -> dict[str, Any]:
    """Make the change of the measurements again that was taken back last."""
    with refusing():
        desk.redo()
    return _measured(desk, facts)


@router.post("/measurements/clear")
def clear(desk: Desk, facts: Facts) -> dict[str, Any]:
    """Measure nothing any more; undo brings all of it back."""
    desk.clear()
    return facts()


@router.put("/measurements/intervals")
def order_intervals(order: IntervalsOrder, desk: Desk, facts: Facts) -> dict[str, Any]:
    """State intervals without waiting until the hull is quiet, or give them up."""
    if order.action == "start":
        desk.start_intervals()
    else:
        desk.cancel_intervals()
    return facts()


@router.post("/measurements/import")
async def take_in(
    request: Request,
    desk: Desk,
    facts: Facts,
    name: Annotated[str, Query(max_length=400, description="Of the file.")] = "",
) -> dict[str, Any]:
    """Measure what a JSON or CSV file of measurements asks for: all of it, or nothing.

    What is here already and the same stays as it is. Numbers in the file are not taken over: each
    is measured anew on the hull on show.
    """
    try:
        content = b"".join([piece async for piece in request.stream()])
    except ClientDisconnect as error:
        raise HTTPException(
            413, f"The upload ended early, or holds more than {MAX_BYTES} bytes."
        ) from error
    with refusing():
        called = shown_name(name)
        entries = await run_in_threadpool(measurements_from_bytes, content, called)
        desk.take_in(tuple(entry.spec for entry in entries))
    return await run_in_threadpool(_measured, desk, facts)


# Not a coroutine: it may wait for a hull that is being measured.
@router.get("/measurements.{ending}")
@router.get("/export/measurements.{ending}")
def read_file(
    ending: Literal["csv", "json"],
    request: Request,
    stream: Stream,
    frame: Annotated[FrameName, Query(description="In which directions are given.")] = "target",
) -> Response:
    """Return the measurements as a file, all of them of the hull on show."""
    state = request.app.state
    attitudes: Attitudes = state.attitudes
    snapshot, source = stream.snapshot, stream.source
    try:
        content = measurements_file(
            ending,
            desk=state.desk,
            snapshot=snapshot,
            source=source,
            attitude=attitudes.learned(LEARNED_WITHIN_S),
            frame=frame,
        )
    except ValueError as error:
        raise HTTPException(409, str(error)) from error
    name = file_name(f"measurements.{ending}", snapshot, source)
    return Response(
        content,
        media_type="text/csv; charset=utf-8" if ending == "csv" else "application/json",
        headers={
            "Content-Disposition": f'attachment; filename="{name}"',
            "Cache-Control": "no-store",
        },
    )


def _spec(values: dict[str, Any], desk: MeasurementDesk) -> Spec:
    """Return the spec that a body describes, with a free name where it brings none."""
    kind = values.get("kind")
    if "name" not in values and kind in KINDS.values():
        values = {**values, "name": desk.free_name(str(kind))}
    return spec_from_json(values)


def _replacing(name: str, values: dict[str, Any], desk: MeasurementDesk) -> Spec:
    """Return the spec that a body describes; name and note stay where it brings none."""
    return spec_from_json({"name": name, "note": desk.book.entry(name).spec.note, **values})


def _changed(book: MeasurementBook, order: ChangeOrder, spec: Spec | None) -> MeasurementBook:
    """Return the book with all that an order asks, as one step."""
    before, name = book, order.name
    book.entry(name)
    if spec is not None:
        book, name = book.replaced(name, spec), spec.name
    if order.note is not None:
        book = book.noted(name, order.note)
    if order.is_hidden is not None:
        book = book.hidden(name, order.is_hidden)
    if order.rename is not None and order.rename != name:
        book = book.renamed(name, order.rename)
    return before.then(book)


def _measured(desk: MeasurementDesk, facts: MeasurementFacts) -> dict[str, Any]:
    desk.wait(MEASURED_WITHIN_S)
    return facts()
