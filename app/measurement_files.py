"""Measurements as files: the book, and the numbers that the hull has by itself."""

from dataclasses import replace
from typing import Any

from app.attitudes import Attitude
from app.components import component_facts
from app.facts import carving_facts, hull_facts
from app.measured_items import Item
from app.measurement_facts import UNOBSERVED, ends, is_told
from app.measuring import MeasurementDesk
from app.measuring_intervals import Intervals
from app.snapshot import Snapshot
from app.source import Source
from core.analysis.hull import Hull
from core.arrays import Floats
from core.formats.measurement_entries import Entry, HullKind, HullNumber, Reading, reading_of
from core.formats.measurements import measurements_to_csv, measurements_to_json
from core.geometry.directions import FrameName
from core.measurement.intervals import Interval
from core.measurement.results import Measurement
from core.silhouettes.silhouette import WHOLE

MEASURED_WITHIN_S = 10.0
"""How long a download waits for a hull that is being measured."""


class BeingMeasured(ValueError):  # noqa: N818 - the state, as a person says it
    """The hull on show has not been measured yet."""


def measurements_file(
    ending: str,
    *,
    desk: MeasurementDesk,
    snapshot: Snapshot,
    source: Source,
    attitude: Attitude,
    frame: FrameName = "target",
) -> bytes:
    """Return all measurements as a .csv or .json file; all of them are of the same hull.

    Args:
        ending: "csv" or "json".
        desk: at which they are kept.
        snapshot: what is on show.
        source: of its frames.
        attitude: of the target frame.
        frame: in which directions are given.

    Raises:
        ValueError: no hull, one that only an outline that is tried has, or a frame that needs an
            orbit where none is known.
        BeingMeasured: the numbers are not there yet.
    """
    hull = snapshot.hull
    if hull is None:
        raise ValueError("There is nothing measured yet; wait for the first frame.")
    if snapshot.is_preview:
        raise ValueError("The hull follows an outline that is not kept yet; keep or discard it.")
    items = _items_of(desk, hull)
    entries = [
        Entry(spec=item.spec, reading=_reading(item, attitude, frame) if is_told(item) else None)
        for item in items
    ]
    intervals = desk.intervals
    if intervals is not None and intervals.revision != hull.revision:
        intervals = None
    if ending == "csv":
        numbers = [*hull_numbers(hull, intervals), *_numbers_of_parts(snapshot)]
        return measurements_to_csv(entries, numbers).encode()
    return measurements_to_json(entries, _about(snapshot, source)).encode()


def _items_of(desk: MeasurementDesk, hull: Hull) -> tuple[Item, ...]:
    """Return the items as measured on a hull."""
    if not desk.wait(MEASURED_WITHIN_S):
        raise BeingMeasured("The hull is being measured still; try again in a moment.")
    items = desk.items
    for item in items:
        if item.result is None or item.result.revision != hull.revision:
            raise BeingMeasured("The hull changed meanwhile; try again.")
    return items


def _reading(item: Item, attitude: Attitude, frame: FrameName) -> Reading:
    assert isinstance(item.result, Measurement)
    low, high = ends(item.interval)
    vector = item.result.direction
    if vector is None:
        return reading_of(item.result, low=low, high=high)
    direction = attitude.direction(vector, is_undirected=item.result.is_undirected)
    return reading_of(item.result, low=low, high=high, direction=direction, frame=frame)


def _about(snapshot: Snapshot, source: Source) -> dict[str, Any]:
    """Return what JSON tells beside the book: the hull with its own numbers, and how it came."""
    return {
        "source": source.name,
        "carving": carving_facts(snapshot.settings),
        "hull": None if snapshot.hull is None else hull_facts(snapshot.hull),
        "components": component_facts(snapshot),
    }


def _numbers_of_parts(snapshot: Snapshot) -> list[HullNumber]:
    """Return the numbers of the parts' own hulls, each named after its part."""
    carved = {label: snapshot.carved(label) for label in snapshot.components if label != WHOLE}
    return [
        replace(number, name=f"{label}: {number.name}")
        for label, found in carved.items()
        if found is not None
        for number in hull_numbers(found[0], None)
    ]


def hull_numbers(hull: Hull, intervals: Intervals | None) -> list[HullNumber]:
    """Return the hull's extents, principal lines and volume; what is not bounded has no reading.

    Their directions are in the target frame.
    """
    none = (None,) * 3
    extents, lines = (none, none) if intervals is None else (intervals.extents, intervals.lines)
    is_bounded = all(extent.is_bounded for extent in hull.extents) and bool(hull.extents)
    volume = None if intervals is None else intervals.volume
    return [
        *(
            _number(hull, "hull extent", each.name, each.value_m, each.direction, interval)
            if each.is_bounded
            else HullNumber(kind="hull extent", name=each.name, reading=None)
            for each, interval in zip(hull.extents, extents, strict=False)
        ),
        *(
            _number(hull, "hull line", each.name, each.length_m, each.direction, interval)
            if grade != UNOBSERVED
            else HullNumber(kind="hull line", name=each.name, reading=None)
            for each, grade, interval in zip(hull.lines, hull.line_grades, lines, strict=False)
        ),
        _number(hull, "hull volume", "volume", hull.volume_m3, None, volume)
        if is_bounded
        else HullNumber(kind="hull volume", name="volume", reading=None),
    ]


def _number(
    hull: Hull,
    kind: HullKind,
    name: str,
    value: float,
    direction: Floats | None,
    interval: Interval | None,
) -> HullNumber:
    low, high = ends(interval)
    reading = Reading(
        value=value,
        unit="m³" if direction is None else "m",
        low=low,
        high=high,
        direction=direction,
        is_undirected=direction is not None,
        revision=hull.revision,
        threshold=hull.threshold,
    )
    return HullNumber(kind=kind, name=name, reading=reading)
