"""The JSON interface to picking: what a page measures by clicks, and clicks without a browser."""

from typing import Annotated, Any

import numpy as np
from fastapi import APIRouter, Depends, HTTPException
from pydantic import BaseModel, ConfigDict
from starlette.requests import HTTPConnection

from app.picking import Kind, Ray, Snap
from app.viewport_api import PageName, Vector
from app.viewport_picking import Pickers

router = APIRouter(prefix="/api/viewport/{name}/picking")


def _pickers(connection: HTTPConnection) -> Pickers:
    pickers: Pickers = connection.app.state.pickers
    return pickers


Picks = Annotated[Pickers, Depends(_pickers)]


class PickingOrder(BaseModel):
    """What a page measures, and what its clicks snap to."""

    model_config = ConfigDict(extra="forbid")

    kind: Kind
    snap: Snap = "surface"


class RayOrder(BaseModel):
    """A click, as the ray through it in the target frame."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)

    origin_m: Vector
    direction: Vector
    snap: Snap | None = None


@router.put("")
def begin(name: PageName, order: PickingOrder, picks: Picks) -> dict[str, Any]:
    """Let a page pick for a kind of measurement; picks for the same kind stay."""
    picks.begin(name, order.kind, order.snap)
    return _facts(name, picks)


@router.delete("")
def stop(name: PageName, picks: Picks) -> dict[str, Any]:
    """Let a page pick no longer."""
    picks.stop(name)
    return _facts(name, picks)


@router.post("/picks")
def click(name: PageName, order: RayOrder, picks: Picks) -> dict[str, Any]:
    """Pick by a ray, as a click on the page does."""
    try:
        ray = Ray(origin_m=np.array(order.origin_m), direction=np.array(order.direction))
        picks.click(name, ray, order.snap)
    except ValueError as error:
        raise HTTPException(409, str(error)) from error
    return _facts(name, picks)


@router.delete("/picks/last")
def take_back(name: PageName, picks: Picks) -> dict[str, Any]:
    """Forget a page's last pick."""
    try:
        picks.take_back(name)
    except ValueError as error:
        raise HTTPException(409, str(error)) from error
    return _facts(name, picks)


@router.post("/end")
def finish(name: PageName, picks: Picks) -> dict[str, Any]:
    """End a polyline."""
    try:
        picks.finish(name)
    except ValueError as error:
        raise HTTPException(409, str(error)) from error
    return _facts(name, picks)


def _facts(name: str, picks: Pickers) -> dict[str, Any]:
    return {"picking": picks.facts().get(name)}
