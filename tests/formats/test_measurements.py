import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.formats.measurement_entries import Entry, Reading
from core.formats.measurements import (
    measurements_from_csv,
    measurements_from_json,
    measurements_to_csv,
    measurements_to_json,
    read_measurements,
    write_measurements,
)
from core.measurement import anchors, regions, specs

FINITE = st.floats(allow_nan=False, allow_infinity=False)
POINTS = st.tuples(FINITE, FINITE, FINITE).map(np.array)
DIRECTIONS = (
    st.tuples(*[st.floats(-1, 1)] * 3).map(np.array).filter(lambda v: np.linalg.norm(v) > 1e-3)
)
LENGTHS = st.floats(1e-6, 1e6)
TEXT = st.text(st.characters(exclude_categories=("Cc", "Cs")), min_size=1, max_size=20).filter(
    str.strip
)
NOTES = st.text(
    st.one_of(st.characters(exclude_categories=("Cc", "Cs")), st.sampled_from('\n\t,"'))
)

ANCHORS = st.one_of(
    st.builds(anchors.Point, point_m=POINTS),
    st.builds(anchors.KeyPoint, name=TEXT),
    st.builds(anchors.PickRay, origin_m=POINTS, direction=DIRECTIONS),
    st.builds(anchors.SurfacePoint, near_m=POINTS, reach_m=LENGTHS),
    st.builds(
        anchors.Extreme, near_m=POINTS, direction=DIRECTIONS, radius_m=LENGTHS, cap_m=LENGTHS
    ),
    st.builds(anchors.PartEnd, near_m=POINTS, toward=DIRECTIONS, reach_m=LENGTHS),
)
BODIES = st.one_of(
    st.builds(regions.WholeSurface),
    st.builds(regions.ConnectedPart, near_m=POINTS, reach_m=LENGTHS),
)
REGIONS = st.one_of(
    BODIES,
    st.builds(regions.Ball, near_m=POINTS, radius_m=LENGTHS),
    st.builds(
        regions.Patch,
        near_m=POINTS,
        angle_rad=st.floats(0.01, 3),
        growth=st.sampled_from(["flat", "smooth"]),
        radius_m=st.one_of(st.none(), LENGTHS),
    ),
)
READINGS = st.builds(
    Reading,
    value=FINITE,
    unit=st.sampled_from(["m", "m²", "m³", "rad", ""]),
    direction=st.one_of(st.none(), DIRECTIONS),
    frame=st.sampled_from(["target", "RTN"]),
    is_undirected=st.booleans(),
    revision=st.integers(0, 2**40),
    threshold=st.integers(0, 500),
)


def spec_of(name, note, kind, draw):
    named = {"name": name, "note": note}
    pair = {"start": ANCHORS, "end": ANCHORS}
    more = {
        specs.Length: pair,
        specs.LineFeature: pair,
        specs.Polyline: {"anchors": st.lists(ANCHORS, min_size=2, max_size=4).map(tuple)},
        specs.PlaneThrough: {"anchors": st.tuples(ANCHORS, ANCHORS, ANCHORS)},
        specs.Section: {"normal": DIRECTIONS, "through": ANCHORS},
        specs.Area: {"region": REGIONS},
        specs.LineAxis: {"region": REGIONS},
        specs.CylinderAxis: {"region": REGIONS},
        specs.PlaneNormal: {"region": REGIONS},
    }.get(kind, {"region": BODIES})
    return kind(**named, **{field: draw(values) for field, values in more.items()})


KINDS = [
    *(specs.Length, specs.LineFeature, specs.Polyline, specs.LineAxis, specs.CylinderAxis),
    *(specs.PlaneNormal, specs.PlaneThrough, specs.PrincipalAxes, specs.BoundingBox),
    *(specs.OrientedBox, specs.Volume, specs.Area, specs.Section),
]


@st.composite
def entries(draw):
    names = draw(st.lists(TEXT, min_size=2, max_size=4, unique=True))
    found = [
        Entry(
            spec=spec_of(name, draw(NOTES), draw(st.sampled_from(KINDS)), draw),
            reading=draw(st.one_of(st.none(), READINGS)),
        )
        for name in names[:-1]
    ]
    kind = draw(st.sampled_from([specs.AngleBetween, specs.ScaleFactor]))
    return [*found, Entry(spec=kind(name=names[-1], first=names[0], second=names[0]))]


@given(entries())
@settings(max_examples=40)
def test_measurements_come_back_unchanged_from_both_formats(chosen):
    as_json, as_csv = measurements_to_json(chosen), measurements_to_csv(chosen)
    for back in (measurements_from_json(as_json), measurements_from_csv(as_csv)):
        assert measurements_to_json(back) == as_json
        assert measurements_to_csv(back) == as_csv
        assert [type(entry.spec) for entry in back] == [type(entry.spec) for entry in chosen]


def span():
    return Entry(
        spec=specs.Length(
            name="span",
            note="tip, to tip",
            start=anchors.Extreme(near_m=[0, 8, 0], direction=[0, 1, 0], radius_m=2, cap_m=0.2),
            end=anchors.PickRay(origin_m=[0, -20, 0], direction=[0, 1, 0]),
        ),
        reading=Reading(
            value=17.0,
            unit="m",
            low=16.9,
            high=17.1,
            direction=[0, 1, 0],
            frame="TEME",
            epoch_utc="2026-03-01T12:00:00Z",
            revision=3,
            threshold=60,
        ),
    )


@pytest.mark.parametrize("ending", ["json", "csv"])
def test_files_are_written_and_read(tmp_path, ending):
    path = tmp_path / f"lengths.{ending}"
    write_measurements(path, [span()])
    assert measurements_to_json(read_measurements(path)) == measurements_to_json([span()])
    write_measurements(path, [])
    assert read_measurements(path) == ()
    assert list(tmp_path.iterdir()) == [path]


def changed(**fields):
    content = json.loads(measurements_to_json([span()]))
    content["measurements"][0] |= fields
    return json.dumps(content)


def reading(**fields):
    content = json.loads(measurements_to_json([span()]))
    content["measurements"][0]["reading"] |= fields
    return json.dumps(content)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "is no JSON"),
        ("[]", 'its "format" is not'),
        ('{"format": "radarhull measurements", "version": 2}', "of version 2"),
        ('{"format": "radarhull measurements", "version": 1}', 'no list of "measurements"'),
        (changed(kind="width"), "is of kind 'width'; known are"),
        (changed(start={"kind": "vertex", "number": 3}), "start is of kind 'vertex'; known are"),
        (changed(start=None), "start must be an object, got nothing"),
        (changed(colour="red"), 'a field "colour" that is not known'),
        (changed(name=""), "needs a name"),
        (changed(name=3), "name must be text, got 3"),
        (changed(name="a\nb"), "control character"),
        (reading(frame="ECI"), 'the frame must be one of target, RTN, TEME, got "ECI"'),
        (reading(frame="RTN"), "in TEME, and no other, has an epoch"),
        (reading(unit="ft"), 'got "ft"'),
        (reading(value=float("nan")), "holds NaN"),
        (reading(value="17"), "value must be a number, got '17'"),
        (reading(direction=[0, 1]), "wanted an array of shape 3"),
        (reading(low=18.0), "low end 18.0"),
        (reading(low=None), "both its ends or none"),
        (reading(revision=-1), "whole number from 0 on, got -1"),
        (measurements_to_json([span()]).replace("8.0", "1e999"), "finite number"),
    ],
)
def test_bad_json_is_refused_in_clear_words(text, words):
    with pytest.raises(ValueError, match=words):
        measurements_from_json(text)


def test_two_of_one_name_and_missing_names_are_refused():
    content = json.loads(measurements_to_json([span()]))
    content["measurements"] *= 2
    with pytest.raises(ValueError, match='2 measurements are called "span"'):
        measurements_from_json(json.dumps(content))
    angle = {"kind": "angle between", "name": "a", "first": "span", "second": "length"}
    content["measurements"] = [content["measurements"][0], angle]
    with pytest.raises(ValueError, match='refers to "length"'):
        measurements_from_json(json.dumps(content))


def test_bad_csv_is_refused_in_clear_words():
    good = measurements_to_csv([span()])
    for text, words in (
        ("", "first row must hold the headings"),
        ("name,value\nspan,17\n", "first row must hold the headings"),
        (good + "1,length\n", "Row 3 has 2 cells"),
        (good.replace("TEME", "J2000"), 'Row 2, "span": its reading: the frame must be one of'),
        (good.replace(",17.0,", ",NaN,"), "holds NaN"),
        (good.replace(",17.0,", ",long,"), "Row 2, column value, is no JSON"),
        (good.replace("length,span", "width,span"), "is of kind 'width'"),
        (good + good.splitlines(keepends=True)[1], '2 measurements are called "span"'),
    ):
        with pytest.raises(ValueError, match=words):
            measurements_from_csv(text)


def test_files_that_cannot_be_read_are_refused(tmp_path):
    for name, content, words in (
        ("a.txt", b"", "ends in .json or .csv"),
        ("none.json", None, "could not be read"),
        ("b.json", b"\xff\xfe", "no text in UTF-8"),
    ):
        if content is not None:
            (tmp_path / name).write_bytes(content)
        with pytest.raises(ValueError, match=words):
            read_measurements(tmp_path / name)
