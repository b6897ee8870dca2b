"""How each kind of measurement is read off a surface."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from core.arrays import Floats
from core.measurement import specs as kinds
from core.measurement.anchors import Anchor, place_text
from core.measurement.boxes import least_box
from core.measurement.fits import Fit, cloud_of, fit_cylinder, fit_line, fit_plane
from core.measurement.measuring_job import Job, NothingThereError
from core.measurement.parts import Faces, body_axes, body_of
from core.measurement.regions import area_vectors_m2
from core.measurement.results import Measurement
from core.measurement.sections import section_of

LEAST_LENGTH_M = 1e-9
"""Two places nearer to each other than a nanometre are one."""

LEAST_SINE = 1e-6
"""Of the angle that three points span, below which they lie on one line."""


def scale_factors(lines: Sequence[Measurement]) -> dict[tuple[str, str], float]:
    """Return b = lᵢ/lⱼ of each two measured lengths, by their names in the order given.

    Raises:
        ValueError: something that is no length above zero.

    Source: the paper's scale factors of line features.
    """
    for line in lines:
        if line.unit != "m" or not line.value > 0:
            raise ValueError(
                f'A scale factor needs lengths above zero; "{line.name}" is {line.value} '
                f"{line.unit}."
            )
    return {
        (lines[i].name, lines[j].name): lines[i].value / lines[j].value
        for i in range(len(lines))
        for j in range(i + 1, len(lines))
    }


def _length(spec: kinds.Length | kinds.LineFeature, job: Job) -> Measurement:
    chain = _chain(spec.name, (spec.start, spec.end), job)
    return replace(
        chain, direction=chain.axes[0], is_undirected=isinstance(spec, kinds.LineFeature)
    )


def _polyline(spec: kinds.Polyline, job: Job) -> Measurement:
    return _chain(spec.name, spec.anchors, job)


def _chain(name: str, anchors: Sequence[Anchor], job: Job) -> Measurement:
    places = np.array([job.place(anchor) for anchor in anchors])
    steps = np.diff(places, axis=0)
    sizes = np.linalg.norm(steps, axis=1)
    if float(sizes.min()) < LEAST_LENGTH_M:
        same = int(np.argmin(sizes))
        raise NothingThereError(
            f"Ends {same + 1} and {same + 2} lie on the same point, {place_text(places[same])}, so "
            "there is no line between them; move one of them."
        )
    return Measurement(
        name=name,
        value=float(sizes.sum()),
        unit="m",
        sizes_m=sizes,
        axes=steps / sizes[:, None],
        points_m=places,
    )


def _line_axis(spec: kinds.LineAxis, job: Job) -> Measurement:
    faces = job.faces(spec.region)
    fit = fit_line(cloud_of(job.surface, faces))
    return replace(_fitted(spec.name, fit, faces), value=fit.length_m, unit="m")


def _cylinder_axis(spec: kinds.CylinderAxis, job: Job) -> Measurement:
    faces = job.faces(spec.region)
    fit = fit_cylinder(cloud_of(job.surface, faces))
    return replace(_fitted(spec.name, fit, faces), value=2 * fit.radius_m, unit="m")


def _plane_normal(spec: kinds.PlaneNormal, job: Job) -> Measurement:
    faces = job.faces(spec.region)
    cloud = cloud_of(job.surface, faces)
    fit = fit_plane(cloud)
    found = _fitted(spec.name, fit, faces)
    return replace(found, value=cloud.area_m2, unit="m²", points_m=fit.centre_m[None])


def _fitted(name: str, fit: Fit, faces: Faces) -> Measurement:
    """Return a line or axis with its two ends; its value is for the caller to say."""
    ends = fit.centre_m + np.outer(fit.span_m, fit.direction)
    has_length = fit.length_m > 0
    return Measurement(
        name=name,
        value=0.0,
        unit="",
        direction=fit.direction,
        is_undirected=fit.is_undirected,
        sizes_m=np.array([fit.length_m] if has_length else []),
        axes=fit.direction[None] if has_length else np.empty((0, 3)),
        residual_m=fit.residual_m,
        points_m=ends,
        support=faces,
    )


def _plane_through(spec: kinds.PlaneThrough, job: Job) -> Measurement:
    a, b, c = (job.place(anchor) for anchor in spec.anchors)
    normal = np.cross(b - a, c - a)
    twice_area = float(np.linalg.norm(normal))
    longest = max(float(np.linalg.norm(side)) for side in (b - a, c - b, a - c))
    if twice_area <= max(LEAST_SINE * longest**2, LEAST_LENGTH_M**2):
        raise NothingThereError(
            f"The three points {place_text(a)}, {place_text(b)} and {place_text(c)} lie on one "
            "straight line, so no plane through them is defined; move one aside."
        )
    return Measurement(
        name=spec.name,
        value=twice_area / 2,
        unit="m²",
        direction=normal / twice_area,
        points_m=np.array([a, b, c]),
    )


def _principal_axes(spec: kinds.PrincipalAxes, job: Job) -> Measurement:
    faces = job.faces(spec.region)
    body = body_axes(body_of(job.surface, faces))
    return Measurement(
        name=spec.name,
        value=float(body.extents_m[0]),
        unit="m",
        direction=body.axes[0],
        is_undirected=True,
        sizes_m=body.extents_m,
        axes=body.axes,
        points_m=body.centroid_m[None],
        support=faces,
    )


def _box(spec: kinds.BoundingBox | kinds.OrientedBox, job: Job) -> Measurement:
    faces = job.faces(spec.region)
    points = body_of(job.surface, faces).vertices_m
    if isinstance(spec, kinds.OrientedBox):
        centre, axes, sizes = least_box(points)
    else:
        lower, upper = points.min(axis=0), points.max(axis=0)
        centre, axes, sizes = (lower + upper) / 2, np.eye(3), upper - lower
    longest = int(np.argmax(sizes))
    return Measurement(
        name=spec.name,
        value=float(sizes[longest]),
        unit="m",
        direction=axes[longest],
        is_undirected=True,
        sizes_m=sizes,
        axes=axes,
        points_m=centre[None],
        support=faces,
    )


def _volume(spec: kinds.Volume, job: Job) -> Measurement:
    faces = job.faces(spec.region)
    body = body_of(job.surface, faces)
    return Measurement(name=spec.name, value=body.volume_m3(), unit="m³", support=faces)


def _area(spec: kinds.Area, job: Job) -> Measurement:
    faces = job.faces(spec.region)
    area_m2 = float(np.linalg.norm(area_vectors_m2(job.surface, faces), axis=1).sum())
    return Measurement(name=spec.name, value=area_m2, unit="m²", support=faces)


def _section(spec: kinds.Section, job: Job) -> Measurement:
    place = job.place(spec.through)
    curves, area_m2 = section_of(job.surface, place, spec.normal)
    if not curves:
        raise NothingThereError(
            f"The plane through {place_text(place)} does not cut the hull; move it."
        )
    return Measurement(
        name=spec.name,
        value=area_m2,
        unit="m²",
        direction=spec.normal,
        points_m=place[None],
        curves_m=curves,
    )


def _angle_between(spec: kinds.AngleBetween, job: Job) -> Measurement:
    first, second = job.other(spec.first), job.other(spec.second)
    one, other = _direction(first), _direction(second)
    is_undirected = first.is_undirected or second.is_undirected
    along, across = float(one @ other), float(np.linalg.norm(np.cross(one, other)))
    angle = float(np.arctan2(across, abs(along) if is_undirected else along))
    return Measurement(name=spec.name, value=angle, unit="rad")


def _direction(of: Measurement) -> Floats:
    if of.direction is None:
        raise NothingThereError(f'"{of.name}" has no direction, so it makes no angle.')
    return of.direction


def _scale_factor(spec: kinds.ScaleFactor, job: Job) -> Measurement:
    pair = [job.other(spec.first), job.other(spec.second)]
    if spec.first == spec.second:
        return Measurement(name=spec.name, value=1.0, unit="")
    return Measurement(name=spec.name, value=next(iter(scale_factors(pair).values())), unit="")


MEASURES: Mapping[type, Callable[[Any, Job], Measurement]] = {
    kinds.Length: _length,
    kinds.LineFeature: _length,
    kinds.Polyline: _polyline,
    kinds.ScaleFactor: _scale_factor,
    kinds.LineAxis: _line_axis,
    kinds.CylinderAxis: _cylinder_axis,
    kinds.PlaneNormal: _plane_normal,
    kinds.PlaneThrough: _plane_through,
    kinds.PrincipalAxes: _principal_axes,
    kinds.BoundingBox: _box,
    kinds.OrientedBox: _box,
    kinds.Volume: _volume,
    kinds.Area: _area,
    kinds.Section: _section,
    kinds.AngleBetween: _angle_between,
}
"""What measures each kind of spec."""
