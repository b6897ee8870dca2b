"""Snapshots and records as the JSON that the page and other programs read."""

from typing import Any

import numpy as np

from app.pictures import FLOOR_DB, STEP_DB
from app.playback import SPEEDS_HZ
from app.snapshot import Record, Snapshot
from app.source import Source
from core.arrays import Floats
from core.geometry.track import angles_from_line_of_sight
from core.hull.simplification import Simplified
from core.measurement.extents import Extent
from core.measurement.lines import LineMeasurement


def state_facts(snapshot: Snapshot, source: Source, side_m: float) -> dict[str, Any]:
    """Return what the page shows, apart from the frames themselves."""
    return {
        "source": {
            "name": source.name,
            "description": source.description,
            "expected_frames": source.expected_frames,
        },
        "run": snapshot.run,
        "serial": snapshot.serial,
        "status": snapshot.status,
        "message": snapshot.message,
        "speed_hz": snapshot.speed_hz,
        "speeds_hz": SPEEDS_HZ,
        "frames": len(snapshot.records),
        "times_s": [record.frame.time_s for record in snapshot.records],
        "labels": [record.frame.label for record in snapshot.records],
        "shown": None if snapshot.shown is None else snapshot.shown.number,
        "following": snapshot.chosen is None,
        "window_m": side_m,
        "hull": None if snapshot.hull is None else hull_facts(snapshot.hull),
        "light": None if snapshot.light is None else _light_facts(snapshot.light),
    }


def hull_facts(record: Record) -> dict[str, Any]:
    """Return the hull after a frame; what the views do not bound has no number."""
    is_bounded = all(extent.is_bounded for extent in record.extents)
    return {
        "frames": record.number,
        "views": record.voting,
        "is_empty": record.face_count == 0,
        "vertices": record.vertex_count,
        "faces": record.face_count,
        "volume_m3": record.volume_m3 if is_bounded else None,
        "extents": [_extent_facts(extent) for extent in record.extents],
        "lines": [_line_facts(line) for line in record.lines],
        "unobserved": _vector(record.unobserved),
    }


def _light_facts(light: Simplified) -> dict[str, Any]:
    """Return how the drawn surface differs from the hull; every number is of the hull itself."""
    return {"faces": len(light.surface.faces), "error_m": light.error_m}


def frame_facts(record: Record) -> dict[str, Any]:
    """Return a frame's circumstances, its silhouette, and the hull after it.

    `theta_deg` and `phi_deg` are the line of sight's angles in the target frame, not the station's
    elevation and azimuth.
    """
    frame = record.frame
    theta_rad, phi_rad = angles_from_line_of_sight(frame.line_of_sight)
    return {
        "number": record.number,
        "label": frame.label,
        "note": record.note,
        "sensor": frame.sensor,
        "time_s": frame.time_s,
        "shape": frame.shape,
        "origin_px": _origin_px(record),
        "row_spacing_m": frame.row_spacing_m,
        "column_spacing_m": frame.column_spacing_m,
        "row_resolution_m": frame.row_resolution_m,
        "column_resolution_m": frame.column_resolution_m,
        "line_of_sight": _vector(frame.line_of_sight),
        "theta_deg": float(np.degrees(theta_rad)),
        "phi_deg": float(np.degrees(phi_rad)),
        "image": {"floor_db": FLOOR_DB, "step_db": STEP_DB},
        "silhouette": {
            "rings": [ring.tolist() for ring in record.silhouette.rings],
            "claim": record.silhouette.claim,
            "provenance": record.silhouette.provenance,
            "area_px": record.silhouette.area_px(),
        },
        "hull": hull_facts(record),
    }


def _extent_facts(extent: Extent) -> dict[str, Any]:
    return {
        "name": extent.name,
        "value_m": extent.value_m if extent.is_bounded else None,
        "is_bounded": extent.is_bounded,
        "direction": _vector(extent.direction),
    }


def _line_facts(line: LineMeasurement) -> dict[str, Any]:
    return {
        "name": line.name,
        "length_m": line.length_m,
        "direction": _vector(line.direction),
    }


def _origin_px(record: Record) -> list[float]:
    return [float(place) for place in record.frame.projection.image_points(np.zeros(3))]


def _vector(values: Floats | None) -> list[float] | None:
    return None if values is None else [float(value) for value in values]
