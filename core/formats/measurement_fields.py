"""Specs, anchors, regions and readings as plain JSON values, and back with every field checked."""

import math
import types
from dataclasses import MISSING, fields
from functools import cache
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

import numpy as np

from core.measurement import anchors, regions, specs

KINDS: dict[type, str] = {
    anchors.Point: "point",
    anchors.KeyPoint: "key point",
    anchors.PickRay: "pick ray",
    anchors.SurfacePoint: "surface point",
    anchors.Extreme: "extreme",
    anchors.PartEnd: "part end",
    regions.WholeSurface: "whole surface",
    regions.ConnectedPart: "connected part",
    regions.Ball: "ball",
    regions.Patch: "patch",
    specs.Length: "length",
    specs.LineFeature: "line feature",
    specs.Polyline: "polyline",
    specs.ScaleFactor: "scale factor",
    specs.LineAxis: "line axis",
    specs.CylinderAxis: "cylinder axis",
    specs.PlaneNormal: "plane normal",
    specs.PlaneThrough: "plane through",
    specs.PrincipalAxes: "principal axes",
    specs.BoundingBox: "bounding box",
    specs.OrientedBox: "oriented box",
    specs.Volume: "volume",
    specs.Area: "area",
    specs.Section: "section",
    specs.AngleBetween: "angle between",
}
"""What a file calls each kind; never changed, only added to."""

MOST_ITEMS = 10_000


def encoded(value: Any) -> dict[str, Any]:
    """Return a dataclass as JSON values, with its kind where it is one of several."""
    kind = {"kind": KINDS[type(value)]} if type(value) in KINDS else {}
    return kind | {field.name: _plain(getattr(value, field.name)) for field in fields(value)}


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, tuple):
        return [_plain(item) for item in value]
    return encoded(value) if type(value) in KINDS else value


def decoded(value: Any, wanted: Any, where: str) -> Any:
    """Return the object that JSON values describe.

    Args:
        value: what was read.
        wanted: a dataclass, or a union of dataclasses that the value's kind chooses from.
        where: what the message calls the value.

    Raises:
        ValueError: an unknown kind, unknown, missing or wrong fields; the sentence says where.
    """
    if not isinstance(value, dict):
        raise ValueError(f"{where} must be an object, got {_text(value)}.")
    kind = _chosen(value, wanted, where)
    given = {name: item for name, item in value.items() if name != "kind" or kind not in KINDS}
    known = {field.name: field for field in fields(kind)}
    unknown = sorted(set(given) - set(known))
    if unknown:
        raise ValueError(f'{where} has a field "{unknown[0]}" that is not known there.')
    for name, field in known.items():
        if name not in given and field.default is MISSING and field.default_factory is MISSING:
            raise ValueError(f'{where} lacks its field "{name}".')
    hints = _hints(kind)
    found = {name: _field(item, hints[name], f"{where}, {name}") for name, item in given.items()}
    try:
        return kind(**found)
    except ValueError as error:
        raise ValueError(f"{where}: {str(error).rstrip('.')}.") from error


@cache
def _hints(kind: type) -> dict[str, Any]:
    return get_type_hints(kind)


def _chosen(value: dict[str, Any], wanted: Any, where: str) -> Any:
    choices = get_args(wanted) or (wanted,)
    if len(choices) == 1 and wanted not in KINDS:
        return wanted
    for choice in choices:
        if KINDS[choice] == value.get("kind"):
            return choice
    names = ", ".join(f'"{KINDS[choice]}"' for choice in choices)
    raise ValueError(f"{where} is of kind {_text(value.get('kind'))}; known are {names}.")


def _field(value: Any, hint: Any, where: str) -> Any:
    choices = get_args(hint) if get_origin(hint) in (Union, types.UnionType) else (hint,)
    if type(None) in choices:
        if value is None:
            return None
        (hint,) = (choice for choice in choices if choice is not type(None))
    elif choices[0] in KINDS:
        return decoded(value, hint, where)
    if get_origin(hint) is tuple:
        return tuple(decoded(item, get_args(hint)[0], where) for item in _list(value, where))
    if get_origin(hint) is np.ndarray:
        return np.array([_number(item, where) for item in _list(value, where)], dtype=np.float64)
    if hint is float:
        return _number(value, where)
    if hint is int and (type(value) is not int or not 0 <= value < 2**53):
        raise ValueError(f"{where} must be a whole number from 0 on, got {_text(value)}.")
    if (hint is str or get_origin(hint) is Literal) and not isinstance(value, str):
        raise ValueError(f"{where} must be text, got {_text(value)}.")
    if hint is bool and not isinstance(value, bool):
        raise ValueError(f"{where} must be true or false, got {_text(value)}.")
    return value


def _list(value: Any, where: str) -> list[Any]:
    if not isinstance(value, list) or len(value) > MOST_ITEMS:
        raise ValueError(f"{where} must be a list of at most {MOST_ITEMS}, got {_text(value)}.")
    return value


def _number(value: Any, where: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ValueError(f"{where} must be a number, got {_text(value)}.")
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise ValueError(f"{where} must be a finite number, got {_text(value)}.")
    return number


def _text(value: Any) -> str:
    text = "nothing" if value is None else repr(value)
    return text if len(text) <= 60 else f"{text[:57]}…"
