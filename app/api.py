"""The JSON interface: the state, the frames, and the controls of the live loop."""

from typing import Annotated, Any, Literal

from fastapi import APIRouter, Depends, HTTPException, Response, WebSocket
from pydantic import BaseModel, ConfigDict, Field
from starlette.requests import HTTPConnection
from starlette.websockets import WebSocketDisconnect

from app.changes import Changes
from app.facts import frame_facts, state_facts
from app.pictures import FLOOR_DB, STEP_DB, ColourName, colour_table, encoded_levels
from app.relay import first_to_end
from app.snapshot import Record
from app.stream import LiveStream

router = APIRouter(prefix="/api")


def _live_stream(connection: HTTPConnection) -> LiveStream:
    stream: LiveStream = connection.app.state.stream
    return stream


Stream = Annotated[LiveStream, Depends(_live_stream)]


class PlaybackOrder(BaseModel):
    """What the live loop shall do, and how fast."""

    model_config = ConfigDict(extra="forbid")

    action: Literal["play", "pause", "step", "restart"] | None = None
    speed_hz: float | None = Field(
        default=None, description="Frames per second; null for as fast as they are computed."
    )


class ShownOrder(BaseModel):
    """Which frame shall be shown."""

    model_config = ConfigDict(extra="forbid")

    frame: int | None = Field(description="From 1, or null to follow the latest.")


@router.get("/state")
def read_state(stream: Stream) -> dict[str, Any]:
    """Return what the workstation shows now."""
    return state_of(stream)


@router.get("/colours")
def read_colours(name: ColourName = "magma") -> list[list[int]]:
    """Return the 256 RGB colours of frame pictures, from the lowest level shown to the highest."""
    table: list[list[int]] = colour_table(name).tolist()
    return table


@router.get("/frames/{number}")
def read_frame(number: int, stream: Stream) -> dict[str, Any]:
    """Return a frame's circumstances, its silhouette, and the hull after it."""
    return facts_of(stream, number)


@router.get("/frames/{number}/image")
def read_image(number: int, stream: Stream) -> Response:
    """Return a frame's levels: rows × columns little-endian uint16, n is floor + n · step in dB."""
    levels = encoded_levels(record_at(stream, number).frame)
    rows, columns = levels.shape
    facts = {"Rows": rows, "Columns": columns, "Floor-dB": FLOOR_DB, "Step-dB": STEP_DB}
    return Response(
        levels.tobytes(),
        media_type="application/octet-stream",
        headers={f"X-{name}": str(value) for name, value in facts.items()},
    )


@router.post("/playback")
def order_playback(order: PlaybackOrder, stream: Stream) -> dict[str, Any]:
    """Play, pause, step or restart, and set the speed where one is given."""
    if "speed_hz" in order.model_fields_set:
        try:
            stream.set_speed(order.speed_hz)
        except ValueError as error:
            raise HTTPException(422, str(error)) from error
    if order.action is not None:
        getattr(stream, order.action)()
    return state_of(stream)


@router.post("/shown")
def order_shown(order: ShownOrder, stream: Stream) -> dict[str, Any]:
    """Show one frame while the hull stays the latest, or follow the latest frame again."""
    try:
        stream.choose(order.frame)
    except ValueError as error:
        raise HTTPException(404, str(error)) from error
    return state_of(stream)


@router.websocket("/live")
async def live(page: WebSocket) -> None:
    """Send the state now and after every change."""
    stream: LiveStream = page.app.state.stream
    changes: Changes = page.app.state.changes
    await page.accept()
    try:
        await first_to_end(_send_states(page, stream, changes), _until_hung_up(page))
    except WebSocketDisconnect:
        return


async def _send_states(page: WebSocket, stream: LiveStream, changes: Changes) -> None:
    with changes.watch() as changed:
        while True:
            await changed.wait()
            changed.clear()
            await page.send_json(state_of(stream))


async def _until_hung_up(page: WebSocket) -> None:
    while (await page.receive())["type"] != "websocket.disconnect":
        pass  # whatever it says, it was not asked


def state_of(stream: LiveStream) -> dict[str, Any]:
    """Return what the workstation shows now."""
    facts = state_facts(stream.snapshot, stream.source)
    return facts | {name: tell() for name, tell in stream.also_told.items()}


def facts_of(stream: LiveStream, number: int) -> dict[str, Any]:
    """Return what is known of frame `number`, or answer that there is none."""
    return frame_facts(record_at(stream, number), stream.source.course())


def record_at(stream: LiveStream, number: int) -> Record:
    """Return frame `number`, or answer that there is none."""
    records = stream.snapshot.records
    if not 1 <= number <= len(records):
        raise HTTPException(
            404, f"There is no frame {number}; {len(records)} have arrived so far, from 1."
        )
    return records[number - 1]
