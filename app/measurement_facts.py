"""Measurements as the JSON that the page and other programs read."""

from typing import Any

import numpy as np

from app.attitudes import Attitude, Attitudes
from app.measured_items import Item
from app.measuring import MeasurementDesk
from app.measuring_intervals import Intervals
from core.arrays import Floats
from core.formats.measurement_fields import KINDS
from core.measurement.intervals import Interval
from core.measurement.results import Lost, Measurement
from core.measurement.specs import DependentSpec

UNOBSERVED = "unobserved"


class MeasurementFacts:
    """Tells what the desk shows; made anew only when it has changed, for states are sent often."""

    def __init__(self, desk: MeasurementDesk, attitudes: Attitudes) -> None:
        """Tell of `desk`, with directions in the frames of `attitudes`."""
        self._desk = desk
        self._attitudes = attitudes
        self._made: tuple[object, dict[str, Any]] = (None, {})

    def __call__(self) -> dict[str, Any]:
        """Return what the state shows under "measurements"."""
        desk = self._desk
        serial = desk.serial
        attitude = self._attitudes.now() if desk.book.entries else Attitude()
        key = (serial, attitude.frames, attitude.at_utc)
        made_for, facts = self._made
        if made_for != key:
            facts = measurement_facts(desk, attitude, serial)
            self._made = (key, facts)
        return facts


def measurement_facts(desk: MeasurementDesk, attitude: Attitude, serial: int) -> dict[str, Any]:
    """Return all measurements as they stand."""
    progress, book, found = desk.progress, desk.book, desk.intervals
    return {
        "serial": serial,
        "revision": desk.revision,
        "can_undo": book.can_undo,
        "can_redo": book.can_redo,
        "frames": list(attitude.frames),
        "items": [_item_facts(item, attitude) for item in desk.items],
        "hull": None if found is None else _hull_facts(found),
        "intervals": {
            "is_running": progress.is_running,
            "done": progress.done,
            "total": progress.total,
            "complaint": progress.complaint,
        },
    }


def ends(interval: Interval | None) -> tuple[float | None, float | None]:
    """Return an interval's ends, both None where one cannot be stated.

    Nothing that is measured is negative, so that no interval reaches below zero.
    """
    if interval is None or not interval.is_stated:
        return None, None
    return max(0.0, interval.low), max(0.0, interval.high)


def is_told(item: Item) -> bool:
    """Whether an item has a number that may be told; an unobserved one has words instead."""
    return isinstance(item.result, Measurement) and item.observability != UNOBSERVED


def _item_facts(item: Item, attitude: Attitude) -> dict[str, Any]:
    spec, result = item.spec, item.result
    facts = {
        "name": spec.name,
        "kind": KINDS[type(spec)],
        "note": spec.note,
        "is_hidden": item.is_hidden,
        "refers_to": [spec.first, spec.second] if isinstance(spec, DependentSpec) else [],
        "observability": item.observability,
        "revision": None if result is None else result.revision,
        "threshold": None if result is None else result.threshold,
        "lost": result.reason if isinstance(result, Lost) else None,
    }
    told = result if is_told(item) and isinstance(result, Measurement) else None
    return facts | _value_facts(item, told) | _vector_facts(told, attitude)


def _value_facts(item: Item, result: Measurement | None) -> dict[str, Any]:
    low, high = ends(item.interval) if result else (None, None)
    old, (old_low, old_high) = item.old_interval, ends(item.old_interval)
    interval = item.interval
    return {
        "value": result and result.value,
        "unit": result and result.unit,
        "low": low,
        "high": high,
        "interval_note": "" if interval is None else interval.note or interval.method,
        "old_interval": None
        if old is None or old_low is None or item.observability == UNOBSERVED
        else {
            "value": old.value,
            "low": old_low,
            "high": old_high,
            "revision": item.old_revision,
        },
        "change": result and item.change,
        "residual_m": result and result.residual_m,
    }


def _vector_facts(result: Measurement | None, attitude: Attitude) -> dict[str, Any]:
    facts: dict[str, Any] = dict.fromkeys(("direction", "angles_deg", "rtn", "teme"))
    facts |= {"is_undirected": False, "epoch_utc": "", "sizes_m": [], "axes": []}
    if result is None:
        return facts
    facts |= {"sizes_m": _numbers(result.sizes_m), "axes": result.axes.tolist()}
    angles_rad = result.angles_to_axes_rad()
    if result.direction is None or angles_rad is None:
        return facts
    found = attitude.direction(result.direction, is_undirected=result.is_undirected)
    return facts | {
        "direction": _numbers(found.target),
        "is_undirected": result.is_undirected,
        "angles_deg": _numbers(np.degrees(angles_rad)),
        "rtn": None if found.rtn is None else _numbers(found.rtn),
        "teme": None if found.teme is None else _numbers(found.teme),
        "epoch_utc": found.epoch_utc,
    }


def _hull_facts(found: Intervals) -> dict[str, Any]:
    """Return the intervals of the numbers that every hull has, with the hull's revision."""
    return {
        "revision": found.revision,
        "extents": [ends(each) for each in found.extents],
        "lines": [ends(each) for each in found.lines],
        "volume": ends(found.volume),
    }


def _numbers(values: Floats) -> list[float]:
    return [float(value) for value in values]
