"""Tables, figures and the finding of the experiment on a person with a knife."""

from collections.abc import Mapping

import numpy as np

from core.experiments.human_measures import PersonHull, PersonMeasures
from core.experiments.human_outlined import Outlined
from core.experiments.human_scene import COVER_DB
from core.experiments.results import Figure, Table
from core.measurement.observability import observability

CLEAN, STRICT, COVERED, PLANE, TRUE = (
    "shadow rule",
    "strict rule",
    "under a cover",
    "as if waves were plane",
    "true outlines",
)


def errors_of(found: PersonMeasures, real: PersonMeasures) -> dict[str, tuple[float | None, str]]:
    """Return every measure's error by its name, with its unit."""

    def less(one: float | None, two: float | None) -> float | None:
        return None if one is None or two is None else 1e3 * (one - two)

    offset, true_offset = found.knife_offset_m(), real.knife_offset_m()
    off = None
    if offset is not None and true_offset is not None:
        off = 1e3 * float(np.linalg.norm(offset - true_offset))
    return {
        "height error": (less(found.height_m, real.height_m), "mm"),
        "shoulder width error": (less(found.shoulder_m, real.shoulder_m), "mm"),
        "knife length error": (less(found.knife_m, real.knife_m), "mm"),
        "knife direction error": (found.knife_angle_deg(real), "°"),
        "knife height above the feet, error": (
            less(found.knife_height_m(), real.knife_height_m()),
            "mm",
        ),
        "knife offset from the axis, error": (off, "mm"),
    }


def figures_of(
    hulls: Mapping[str, PersonHull], seen: Mapping[str, Outlined], real: PersonMeasures
) -> list[Figure]:
    """Return agreement and errors of every hull, and how many frames show the knife."""
    figures = []
    for name, hull in hulls.items():
        agreement = hull.agreement
        figures += [
            Figure(name=f"{name}: IoU", value=agreement.intersection_over_union),
            Figure(name=f"{name}: coverage", value=agreement.coverage),
        ]
        for what, (value, unit) in errors_of(hull.measures, real).items():
            if name in (CLEAN, COVERED, TRUE) or not what.startswith("knife"):
                figures.append(Figure(name=f"{name}: {what}", value=value, unit=unit))
    for name, each in seen.items():
        shown = sum(not outline.is_empty for outline in each.knife)
        figures.append(Figure(name=f"{name}: frames with a bright part", value=shown))
    return figures


def people_table(hulls: Mapping[str, PersonHull], real: PersonMeasures) -> Table:
    """Return hulls and the truth as a table."""
    rows = [("truth", "1.000", "1.000", *_cells(real))]
    for name, hull in hulls.items():
        shares = (hull.agreement.intersection_over_union, hull.agreement.coverage)
        rows.append((name, *(f"{share:.3f}" for share in shares), *_cells(hull.measures)))
    return Table(
        title="A person and a knife against the truth",
        columns=(
            "outlines",
            "IoU",
            "coverage",
            "height (m)",
            "shoulders (m)",
            "knife (m)",
            "its direction",
            "above the feet (m)",
            "off the axis, x and y (m)",
        ),
        rows=tuple(rows),
    )


def _cells(measures: PersonMeasures) -> tuple[str, ...]:
    lengths = (measures.height_m, measures.shoulder_m, measures.knife_m, measures.knife_height_m())
    height, shoulder, knife, above = ("" if v is None else f"{v:.3f}" for v in lengths)
    direction, offset = measures.knife_direction, measures.knife_offset_m()
    return (
        height,
        shoulder,
        knife,
        "" if direction is None else _vector(direction * (1 if direction[1] >= 0 else -1)),
        above,
        "" if offset is None else _vector(offset),
    )


def _vector(values: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> str:
    return f"({', '.join(f'{value:+.3f}' for value in values)})"


def directions_table(seen: Outlined) -> Table:
    """Return how well the frames constrain each axis, with and without the circle below."""
    votes, only_above = seen.circles("shadow")
    rows: list[tuple[str, ...]] = []
    for name, views in (
        ("body, both circles", votes),
        ("body, circle above alone", only_above),
        ("knife, frames that show it", seen.votes(seen.knife, "strict")),
    ):
        if not views:
            rows.append((name, "no views", "no views", "no views"))
            continue
        constrained = observability(views)
        rows.append(
            (
                name,
                *(
                    f"{constrained.grade(axis)} ({constrained.dilution(axis):.2f})"
                    for axis in np.eye(3)
                ),
            )
        )
    return Table(
        title="Directions: grade and dilution",
        columns=("views", "x forward", "y right", "z down"),
        rows=tuple(rows),
    )


def finding_of(
    hulls: Mapping[str, PersonHull], seen: Mapping[str, Outlined], real: PersonMeasures
) -> str:
    """Return what was found, in sentences made from the numbers."""
    parts = []
    for name, title in ((CLEAN, "Bare"), (COVERED, f"Under {COVER_DB:g} dB of cover")):
        errors = errors_of(hulls[name].measures, real)
        texts = [
            f"{what} {'none, it was not found' if value is None else f'{value:+.1f} {unit}'}"
            for what, (value, unit) in errors.items()
        ]
        shown = sum(not outline.is_empty for outline in seen[name].knife)
        parts.append(
            f"{title}: IoU {hulls[name].agreement.intersection_over_union:.3f}, "
            f"{', '.join(texts)}, a bright part in {shown} of {len(seen[name].frames)} frames."
        )
    strict, floor = hulls[STRICT].agreement, hulls[TRUE].agreement
    return (
        f"{' '.join(parts)} The strict rule keeps {100 * strict.coverage:.0f} % of the body; true "
        f"outlines give IoU {floor.intersection_over_union:.3f}. {_height_text(seen[CLEAN])}"
    )


def _height_text(seen: Outlined) -> str:
    """Return how well both circles, and the one above alone, measure heights."""
    down = np.array([0.0, 0.0, 1.0])
    both, above = (observability(views).grade(down) for views in seen.circles("shadow"))
    return f"Under the shadow rule heights are {both}, from the circle above alone {above}."
