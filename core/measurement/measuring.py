"""Measuring a hull by specs: every number comes out anew on every hull."""

from collections.abc import Sequence
from dataclasses import replace
from types import MappingProxyType

from core.hull.closed_mesh import Surface
from core.measurement import specs as kinds
from core.measurement.measures import MEASURES
from core.measurement.measuring_job import PLAIN, Job, MeasuringContext, NothingThereError
from core.measurement.results import Lost, Measurement


def measure(
    spec: kinds.Spec, surface: Surface, context: MeasuringContext = PLAIN
) -> Measurement | Lost:
    """Measure a hull's surface by one spec.

    Args:
        spec: what to measure.
        surface: of the hull, target frame.
        context: revision, threshold, key points, and the results that an angle or a scale factor
            refers to.

    Returns:
        The measurement, or why the hull does not allow it.
    """
    revision, threshold = context.revision, context.threshold
    try:
        found = MEASURES[type(spec)](spec, Job(surface=surface, context=context))
    except (NothingThereError, ValueError) as nothing:  # fits and bodies say what is wrong
        return Lost(name=spec.name, reason=str(nothing), revision=revision, threshold=threshold)
    return replace(found, revision=revision, threshold=threshold)


def measure_all(
    specs: Sequence[kinds.Spec], surface: Surface, context: MeasuringContext = PLAIN
) -> tuple[Measurement | Lost, ...]:
    """Measure a hull's surface by all specs, in their order; one that is lost stops no other.

    Raises:
        ValueError: two specs of one name, or one that refers to a name that is missing.
    """
    kinds.check_specs(tuple(specs))
    measured: dict[str, Measurement | Lost] = {}
    for dependent in (False, True):
        within = replace(context, measured=MappingProxyType(dict(measured)))
        for spec in specs:
            if isinstance(spec, kinds.DependentSpec) is dependent:
                measured[spec.name] = measure(spec, surface, within)
    return tuple(measured[spec.name] for spec in specs)
