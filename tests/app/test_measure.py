import csv
import json
import re

import numpy as np
import pytest
import trimesh

from app.command_line import main
from core.formats.measurement_entries import Entry
from core.formats.measurements import read_measurements, write_measurements
from core.formats.pass_file import RecordedPass, write_pass
from core.measurement.anchors import Point
from core.measurement.regions import ConnectedPart
from core.measurement.specs import (
    Length,
    LineFeature,
    PlaneThrough,
    PrincipalAxes,
    Volume,
)
from tests.app.synthetic import frames

CARVING = ("--spacing-m", "0.5", "--side-m", "24", "--rule", "strict")

TLE = """TARGET
1 25544U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2927
2 25544  51.6416 247.4627 0006703 130.5360 325.0288 15.72125391563537
"""


def measured(capsys, *words):
    """Run the command, which must not fail; return its standard output and its notes."""
    main(["measure", *map(str, words)])
    said = capsys.readouterr()
    return said.out, [line for line in said.err.splitlines() if line.startswith("radarhull")]


def refused(capsys, *words):
    with pytest.raises(SystemExit) as ended:
        main(["measure", *map(str, words)])
    assert ended.value.code == 2
    (line,) = [s for s in capsys.readouterr().err.splitlines() if s.startswith("radarhull: ")]
    return line


@pytest.fixture(scope="module")
def mesh(tmp_path_factory):
    path = tmp_path_factory.mktemp("mesh") / "box.stl"
    trimesh.creation.box(extents=(4.0, 2.0, 1.0)).export(path)
    return path


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    path = tmp_path_factory.mktemp("pass") / "frames.h5"
    write_pass(path, RecordedPass(frames=tuple(frames(12))))
    return path


def spec_file(path, *specs):
    write_measurements(path, [Entry(spec=spec) for spec in specs])
    return path


def length(name, first, second):
    return Length(name=name, start=Point(point_m=first), end=Point(point_m=second))


def test_a_mesh_is_measured_as_it_is(capsys, mesh):
    facts, notes = measured(capsys, mesh, "--json", "-")
    facts = json.loads(facts)
    values = {row["name"]: row["reading"]["value"] for row in facts["measurements"]}
    assert values == pytest.approx(
        {"extents": 4, "principal lines": 4, "box": 4, "volume": 8, "area": 28}
    )
    assert all(row["reading"]["low"] is None for row in facts["measurements"])
    assert facts["details"][0]["sizes_m"] == [4, 2, 1]
    assert len(notes) == 1
    assert "without views" in notes[0]


def test_an_open_mesh_is_told(capsys, tmp_path):
    box = trimesh.creation.box()
    box.update_faces(np.arange(12) > 1)
    box.export(tmp_path / "open.stl")
    assert "not closed" in measured(capsys, tmp_path / "open.stl")[1][1]


def test_passes_are_carved_and_every_number_has_its_interval(capsys, recorded, tmp_path):
    out = tmp_path / "out.csv"
    table, _ = measured(capsys, recorded, *CARVING, "--csv", out)
    assert "95 % interval" in table
    seen = [entry for entry in read_measurements(out) if entry.reading is not None]
    assert seen
    for entry in seen:
        assert entry.reading.low < entry.reading.value < entry.reading.high
        assert entry.reading.threshold > 0


def test_what_is_not_observed_is_never_a_number(capsys, recorded, tmp_path):
    alike = tmp_path / "alike.h5"
    write_pass(alike, RecordedPass(frames=tuple(frames(6))[:1] * 3))
    out = tmp_path / "out.json"
    table, _ = measured(capsys, alike, *CARVING, "--no-intervals", "--json", out)
    assert "not observed" in table
    assert "interval" not in table
    facts = json.loads(out.read_text())
    assert facts["measurements"][3]["kind"] == "volume"
    assert facts["measurements"][3]["reading"] is None
    assert None in facts["details"][0]["sizes_m"]


@pytest.mark.parametrize("ending", ["csv", "json"])
def test_its_own_output_is_read_again_unchanged(capsys, mesh, tmp_path, ending):
    wanted = spec_file(
        tmp_path / "spec.json",
        LineFeature(name="l₁", start=Point(point_m=[2, 0, 0]), end=Point(point_m=[-2, 0, 0])),
        Volume(name="v", region=ConnectedPart(near_m=[2, 0, 0])),
    )
    first, second = tmp_path / f"first.{ending}", tmp_path / f"second.{ending}"
    measured(capsys, mesh, "--spec", wanted, f"--{ending}", first)
    measured(capsys, mesh, "--spec", first, f"--{ending}", second)
    assert first.read_bytes() == second.read_bytes()
    names = [entry.spec.name for entry in read_measurements(first)]
    assert names == ["l₁", "v"]


def test_what_is_lost_says_so_in_its_row_and_stops_no_other(capsys, mesh, tmp_path):
    wanted = spec_file(
        tmp_path / "spec.csv",
        length("same", [1, 1, 1], [1, 1, 1]),
        PlaneThrough(name="in line", anchors=tuple(Point(point_m=[i, 0, 0]) for i in range(3))),
        PrincipalAxes(name="gone", region=ConnectedPart(near_m=[50, 0, 0])),
        length("whole", [0, 0, 0], [3, 4, 0]),
    )
    out = tmp_path / "out.json"
    table, notes = measured(capsys, mesh, "--spec", wanted, "--json", out)
    assert table.count("lost: ") == 3
    assert "5.000 m" in table
    assert "3 of 4 measurements are lost" in notes[-1]
    reasons = [each["lost"] or "" for each in json.loads(out.read_text())["details"]]
    for words, reason in zip(
        ("same point", "straight line", "pick it again"), reasons, strict=False
    ):
        assert words in reason
    assert reasons[3] == ""


def test_directions_are_given_in_all_frames_where_the_orbit_is_known(capsys, mesh, tmp_path):
    elements, out = tmp_path / "target.tle", tmp_path / "out.csv"
    elements.write_text(TLE)
    wanted = spec_file(tmp_path / "spec.json", length("ahead", [0, 0, 0], [2, 0, 0]))
    words = ("--spec", wanted, "--tle", elements, "--at", "2008-09-20T12:25:40", "--frame", "RTN")
    table, _ = measured(capsys, mesh, *words, "--csv", out)
    assert "in RTN" in table
    assert "in TEME" in table
    (row,) = csv.DictReader(out.read_text(encoding="utf-8").splitlines())
    assert row["frame"] == "RTN"
    # Along the track is transverse.
    assert [float(row[axis]) for axis in "xyz"] == pytest.approx([0, 1, 0])
    facts = json.loads(measured(capsys, mesh, *words[:-2], "--json", "-")[0])["details"][0]
    assert np.linalg.norm(facts["teme"]) == pytest.approx(1)
    assert facts["epoch_utc"].startswith("2008-09-20T12:25:40")
    assert "tells no time" in refused(capsys, mesh, "--tle", elements)


@pytest.mark.parametrize(
    ("content", "wanted"),
    [
        ("{", "no JSON"),
        ('{"format": "other"}', "holds no measurements"),
        ('[{"kind": "girth", "name": "g"}]', r'kind .girth.; known are "length"'),
        ('[{"kind": "volume", "name": "v"}, {"kind": "volume", "name": "v"}]', "called"),
        (
            '[{"kind": "volume", "name": "v", "reading": {"value": 1, "unit": "m³", '
            '"frame": "J2000"}}]',
            "must be one of target, RTN, TEME",
        ),
        ("[]", "leave --spec out"),
    ],
)
def test_a_spec_file_that_cannot_be_used_is_refused_in_one_line(
    capsys, mesh, tmp_path, content, wanted
):
    path = tmp_path / "spec.json"
    if content.startswith("["):
        content = f'{{"format": "radarhull measurements", "version": 1, "measurements": {content}}}'
    path.write_text(content, encoding="utf-8")
    assert re.search(wanted, refused(capsys, mesh, "--spec", path))


@pytest.mark.parametrize(
    ("words", "wanted"),
    [
        (("no.h5",), "no.h5"),
        (("no.glb",), "There is no mesh file"),
        (("BOX", "BOX"), "measured alone"),
        (("BOX", "--spec", "no.json"), "could not be read"),
        (("BOX", "--spec", "no.txt"), "ends in .json or .csv"),
        (("BOX", "--csv", "out.txt"), ".csv"),
        (("BOX", "--frame", "TEME"), "--tle FILE"),
        (("BOX", "--frame", "J2000"), "J2000"),
        (("BOX", "--edge-cells", "0"), "above 0"),
    ],
)
def test_bad_words_are_refused_in_one_line(capsys, mesh, words, wanted):
    assert wanted in refused(capsys, *(mesh if word == "BOX" else word for word in words))
