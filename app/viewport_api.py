"""The JSON interface to a page's own view in space: its layers and its camera."""

from typing import Annotated, Any

import numpy as np
from fastapi import APIRouter, Depends, HTTPException, Path
from pydantic import BaseModel, ConfigDict, Field
from starlette.requests import HTTPConnection

from app.api import Stream
from app.camera import VIEWS, Camera
from app.components import colours_of
from app.layers import (
    FIRST_LAYERS,
    LAYERS,
    REFERENCE_LAYERS,
    Layer,
    css,
    known_layers,
)
from app.viewport_pages import ViewportPages

router = APIRouter(prefix="/api/viewport")

PageName = Annotated[str, Path(pattern=r"^[A-Za-z0-9-]{1,64}$")]


def _viewport_pages(connection: HTTPConnection) -> ViewportPages:
    pages: ViewportPages = connection.app.state.viewport_pages
    return pages


Pages = Annotated[ViewportPages, Depends(_viewport_pages)]

Vector = Annotated[list[float], Field(min_length=3, max_length=3)]


class LayersOrder(BaseModel):
    """Which layers a page shows."""

    model_config = ConfigDict(extra="forbid")

    layers: list[str] = Field(max_length=64)


class CameraOrder(BaseModel):
    """Where a page's camera shall stand, in metres of the target frame."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)

    position: Vector
    look_at: Vector
    up: Vector
    field_of_view_deg: float


class ViewOrder(BaseModel):
    """Which named view a page shall take."""

    model_config = ConfigDict(extra="forbid")

    view: str


@router.get("")
def read_choices(stream: Stream, pages: Pages) -> dict[str, Any]:
    """Return the layers, the named views, and the colours of the hull's components."""
    snapshot = stream.snapshot
    colours = colours_of(snapshot)
    offered = [
        layer for layer in LAYERS if layer.name not in REFERENCE_LAYERS or pages.has_reference
    ]
    return {
        "layers": [_layer_facts(layer) for layer in offered],
        "views": [{"name": view.name, "hint": view.hint} for view in VIEWS.values()],
        "components": [
            {"label": label, "colour": css(colours[label])} for label in snapshot.components
        ],
    }


@router.get("/{name}")
def read_page(name: PageName, pages: Pages) -> dict[str, Any]:
    """Return a page's layers, and its camera once its view in space has connected."""
    camera = pages.camera(name)
    return {
        "layers": sorted(pages.layers(name)),
        "camera": None if camera is None else _camera_facts(camera),
    }


@router.put("/{name}/layers")
def order_layers(name: PageName, order: LayersOrder, pages: Pages) -> dict[str, Any]:
    """Show these layers on a page, and no others."""
    try:
        pages.show_layers(name, known_layers(order.layers))
    except ValueError as error:
        raise HTTPException(422, str(error)) from error
    return read_page(name, pages)


@router.put("/{name}/camera")
def order_camera(name: PageName, order: CameraOrder, pages: Pages) -> dict[str, Any]:
    """Put a page's camera somewhere; it moves once its view in space has connected."""
    try:
        camera = Camera(
            position_m=np.array(order.position),
            look_at_m=np.array(order.look_at),
            up=np.array(order.up),
            field_of_view_rad=float(np.radians(order.field_of_view_deg)),
        )
    except ValueError as error:
        raise HTTPException(422, str(error)) from error
    pages.move_camera(name, camera)
    return _camera_facts(camera)


@router.put("/{name}/view")
def order_view(name: PageName, order: ViewOrder, stream: Stream, pages: Pages) -> dict[str, Any]:
    """Let a page look along an axis, or as the frame on show does."""
    if order.view not in VIEWS:
        raise HTTPException(
            404, f"There is no view {order.view!r}; the views are {', '.join(VIEWS)}."
        )
    snapshot = stream.snapshot
    frame = None if snapshot.shown is None else snapshot.shown.frame
    make = VIEWS[order.view].camera
    try:
        camera = make(snapshot.settings.side_m, pages.aspect(name), frame)
    except ValueError as error:
        raise HTTPException(409, str(error)) from error
    pages.move_camera(name, camera)
    return _camera_facts(camera)


def _layer_facts(layer: Layer) -> dict[str, Any]:
    return {
        "name": layer.name,
        "title": layer.title,
        "hint": layer.hint,
        "colour": css(layer.colour),
        "is_on": layer.name in FIRST_LAYERS,
    }


def _camera_facts(camera: Camera) -> dict[str, Any]:
    return {
        "position": camera.position_m.tolist(),
        "look_at": camera.look_at_m.tolist(),
        "up": camera.up.tolist(),
        "field_of_view_deg": float(np.degrees(camera.field_of_view_rad)),
    }
