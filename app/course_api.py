"""The passes over time: the page draws its plots from them."""

from typing import Any

from fastapi import APIRouter

from app.api import Stream
from app.course_facts import pass_facts

router = APIRouter(prefix="/api")


@router.get("/course")
def read_course(stream: Stream) -> dict[str, Any]:
    """Return each pass over time, with all of its intervals; none where no track is known.

    `theta_deg` and `phi_deg` are the line of sight's angles in the target frame. Start, stop and
    middle are seconds on the time scale of the pass's frames.
    """
    return {"passes": [pass_facts(each) for each in stream.source.course()]}
