"""The JSON interface to the comparison with the reference mesh."""

from typing import Annotated, Any

from fastapi import APIRouter, Depends, HTTPException
from starlette.requests import HTTPConnection

from app.reference import ReferenceDesk

router = APIRouter(prefix="/api/reference")


def _reference_desk(connection: HTTPConnection) -> ReferenceDesk:
    desk: ReferenceDesk | None = connection.app.state.reference_desk
    if desk is None:
        raise HTTPException(
            404, "There is no reference mesh; start with radarhull serve --reference FILE."
        )
    return desk


Reference = Annotated[ReferenceDesk, Depends(_reference_desk)]


@router.get("")
def read_reference(reference: Reference) -> dict[str, Any]:
    """Return how the hull that was last compared agrees with the reference."""
    return reference.facts()


@router.post("/comparison")
def order_comparison(reference: Reference) -> dict[str, Any]:
    """Begin to compare the hull on show; the state tells when that is done."""
    reference.request()
    return reference.facts()
