"""Snapshots and records as the JSON that the page and other programs read."""

from dataclasses import asdict
from typing import Any

import numpy as np

from app.course_facts import interval_facts
from app.pictures import FLOOR_DB, STEP_DB
from app.playback import SPEEDS_HZ
from app.snapshot import Record, Snapshot
from app.source import Source
from core.analysis.hull import Hull
from core.arrays import Floats
from core.geometry.track import angles_from_line_of_sight
from core.hull.simplification import Simplified
from core.measurement.extents import Extent
from core.measurement.lines import LineMeasurement
from core.measurement.observability import Grade
from core.radar.course import PassCourse
from core.reconstruction import ReconstructionSettings
from core.silhouettes.extraction import ExtractionSettings


def state_facts(snapshot: Snapshot, source: Source) -> dict[str, Any]:
    """Return what the page shows, apart from the frames themselves."""
    return {
        "source": {
            "name": source.name,
            "description": source.description,
            "expected_frames": source.expected_frames,
            "key": source.key,
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
        "window_m": snapshot.settings.side_m,
        "carving": carving_facts(snapshot.settings),
        "extraction": _extraction_facts(snapshot.settings.extraction),
        "frames_info": [frame_info(record) for record in snapshot.records],
        "sights": [_vector(record.frame.line_of_sight) for record in snapshot.records],
        "blind": [_vector(blind_direction(record)) for record in snapshot.records],
        "latency_ms": {"last": snapshot.latency_ms},
        "hull": None if snapshot.hull is None else hull_facts(snapshot.hull),
        "residuals": None if snapshot.residuals is None else asdict(snapshot.residuals),
        "light": None if snapshot.light is None else _light_facts(snapshot.light),
    }


def carving_facts(settings: ReconstructionSettings) -> dict[str, Any]:
    """Return by what the hull is carved."""
    return {
        "rule": settings.rule,
        "tolerated_misses": settings.tolerated_misses,
        "spacing_m": settings.spacing_m,
        "side_m": settings.side_m,
        "frame_range": list(settings.frame_range),
    }


def _extraction_facts(settings: ExtractionSettings) -> dict[str, Any]:
    """Return by what radar frames' outlines are detected."""
    return {
        "a1": settings.censoring_factor,
        "a2": settings.detection_factor,
        "closing_px": settings.closing_px,
    }


def frame_info(record: Record) -> dict[str, Any]:
    """Return what the list of all frames shows of one."""
    analysed = record.analysed
    return {
        "number": record.number,
        "state": analysed.state,
        "edited": analysed.history.is_edited,
        "component": analysed.silhouette.component,
        "revision": analysed.history.revision,
        "votes": analysed.votes,
        "held_back": analysed.ballot.view is not None and not analysed.votes,
        "sensor": record.frame.sensor,
    }


def blind_direction(record: Record) -> Floats:
    """Return the (3,) unit direction, target frame, along which a frame measures nothing."""
    return record.frame.projection.viewing_direction()


def hull_facts(hull: Hull) -> dict[str, Any]:
    """Return a hull's numbers; what the views do not bound or do not observe has none."""
    is_bounded = all(extent.is_bounded for extent in hull.extents)
    return {
        "revision": hull.revision,
        "frames": hull.frames,
        "views": hull.voting,
        "threshold": hull.threshold,
        "is_preview": hull.is_preview,
        "is_empty": hull.face_count == 0,
        "emptied_by": list(hull.emptied_by),
        "vertices": hull.vertex_count,
        "faces": hull.face_count,
        "volume_m3": hull.volume_m3 if is_bounded else None,
        "extents": [_extent_facts(extent) for extent in hull.extents],
        "lines": [
            _line_facts(line, grade)
            for line, grade in zip(hull.lines, hull.line_grades, strict=True)
        ],
        "unobserved": _vector(hull.unobserved),
    }


def _light_facts(light: Simplified) -> dict[str, Any]:
    """Return how the drawn surface differs from the hull; every number is of the hull itself."""
    return {"faces": len(light.surface.faces), "error_m": light.error_m}


def frame_facts(record: Record, course: tuple[PassCourse, ...] = ()) -> dict[str, Any]:
    """Return a frame's circumstances, its silhouette, and the hull when it had come.

    `interval` tells what was imaged, where the `course` of the frame's pass is known.
    `theta_deg` and `phi_deg` are the line of sight's angles in the target frame, not the station's
    elevation and azimuth.
    """
    frame = record.frame
    theta_rad, phi_rad = angles_from_line_of_sight(frame.line_of_sight)
    return {
        "number": record.number,
        "label": frame.label,
        "note": record.analysed.note,
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
        "interval": interval_facts(frame, course),
        "state": record.analysed.state,
        "silhouette": _silhouette_facts(record),
        "hull": hull_facts(record.hull),
    }


def _silhouette_facts(record: Record) -> dict[str, Any]:
    silhouette, history = record.silhouette, record.analysed.history
    return {
        "rings": [ring.tolist() for ring in silhouette.rings],
        "claim": silhouette.claim,
        "component": silhouette.component,
        "provenance": silhouette.provenance,
        "area_px": silhouette.area_px(),
        "revision": history.revision,
        "edited": history.is_edited,
        "can_undo": history.can_undo,
        "can_redo": history.can_redo,
        "repair": history.present.repair,
        "vote_repair": record.analysed.vote_repair,
    }


def _extent_facts(extent: Extent) -> dict[str, Any]:
    return {
        "name": extent.name,
        "value_m": extent.value_m if extent.is_bounded else None,
        "is_bounded": extent.is_bounded,
        "observability": extent.observability,
        "direction": _vector(extent.direction),
    }


def _line_facts(line: LineMeasurement, observability: Grade) -> dict[str, Any]:
    return {
        "name": line.name,
        "length_m": None if observability == "unobserved" else line.length_m,
        "observability": observability,
        "direction": _vector(line.direction),
    }


def _origin_px(record: Record) -> list[float]:
    return [float(place) for place in record.frame.projection.image_points(np.zeros(3))]


def _vector(values: Floats | None) -> list[float] | None:
    return None if values is None else [float(value) for value in values]
