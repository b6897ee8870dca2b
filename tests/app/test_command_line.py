import json
import socket

import h5py
import numpy as np
import pytest
import trimesh

from app.command_line import main
from core.formats.pass_file import read_pass


def run(capsys, *words):
    """Run a command and return its standard output; it must not fail."""
    main([str(word) for word in words])
    return capsys.readouterr().out


def refused(capsys, *words):
    """Run a command that must end with exit code 2 and one line, which is returned."""
    with pytest.raises(SystemExit) as ended:
        main([str(word) for word in words])
    assert ended.value.code == 2
    lines = capsys.readouterr().err.strip().splitlines()
    assert len(lines) == 1
    assert lines[0].startswith("radarhull: ")
    return lines[0]


@pytest.fixture(scope="module")
def echoes(tmp_path_factory):
    """A short pass near the zenith as the command line simulates it."""
    path = tmp_path_factory.mktemp("pass") / "echoes.h5"
    main(["simulate", str(path), "--mask-deg", "38", "--scatterers", "8000", "--seed", "3"])
    return path


@pytest.mark.parametrize(
    "command", ["", "serve", "simulate", "import", "image", "reconstruct", "experiment"]
)
def test_every_command_has_help(capsys, command):
    with pytest.raises(SystemExit) as ended:
        main([*command.split(), "--help"])
    assert ended.value.code == 0
    assert "--help" in capsys.readouterr().out


def test_echoes_become_frames_become_a_hull(capsys, echoes, tmp_path):
    framed, hull = tmp_path / "frames.h5", tmp_path / "hull.glb"
    picture = tmp_path / "frame.png"
    assert "512 × 512 pixels" in run(capsys, "image", echoes, framed, "--picture", picture)
    assert picture.stat().st_size > 10_000
    count = len(read_pass(framed).frames)
    assert count >= 4
    # One short pass bounds no extent, so the grid must: what counts is that all agree.
    out = run(capsys, "reconstruct", framed, "--out", hull, "--json", "-", "--spacing-m", 0.3)
    facts = json.loads(out)
    assert facts["views"] == count == facts["threshold"]
    assert facts["unobserved_direction"] is not None
    assert facts["volume_m3"] is None
    extents = trimesh.load(hull, force="mesh").extents
    for extent, side_m in zip(facts["extents"], extents, strict=True):
        assert extent["value_m"] in (None, pytest.approx(side_m))
    assert "not bounded" in run(capsys, "reconstruct", framed, "--spacing-m", 0.5)


def test_measured_echoes_are_imported_and_focused(capsys, shared_data, tmp_path):
    files = sorted((shared_data("gotcha")).glob("*.mat"))
    passed, framed = tmp_path / "gotcha.h5", tmp_path / "focused.h5"
    assert "469 pulses × 424 frequencies" in run(capsys, "import", *files, "--out", passed)
    options = ("--method", "backprojection", "--pixels", 128, "--pixel-spacing-m", 0.2)
    run(capsys, "image", passed, framed, *options)
    (frame,) = read_pass(framed).frames
    assert frame.shape == (128, 128)


def test_a_damaged_mesh_writes_nothing(capsys, tmp_path):
    mesh, out = tmp_path / "empty.obj", tmp_path / "out.h5"
    mesh.write_text("# no vertices\n")
    assert "empty.obj" in refused(capsys, "simulate", out, "--mesh", mesh)
    assert not out.exists()


def test_a_wrong_checksum_writes_nothing(capsys, tmp_path):
    sets, out = tmp_path / "sets.tle", tmp_path / "out.h5"
    sets.write_text(
        "1 37820U 11053A   16071.47512016  .00017711  00000-0  21761-3 0  9997\n"
        "2 37820  42.7628 110.5320 0009524  97.7639  50.1243 15.59909646255308\n"
    )
    assert "checksum 7" in refused(capsys, "simulate", out, "--tle", sets)
    assert not out.exists()


def test_a_pass_that_does_not_exist_is_counted(capsys, tmp_path):
    line = refused(capsys, "simulate", tmp_path / "out.h5", "--pass-index", 99)
    assert "There is no pass number 99" in line


def test_a_pass_file_cut_in_half_is_refused(capsys, echoes, tmp_path):
    half = tmp_path / "half.h5"
    half.write_bytes(echoes.read_bytes()[:200_000])
    assert "cut short" in refused(capsys, "image", half, tmp_path / "out.h5")
    assert "cut short" in refused(capsys, "serve", half)
    assert list(tmp_path.iterdir()) == [half]


def test_nan_echoes_are_refused(capsys, echoes, tmp_path):
    broken = tmp_path / "broken.h5"
    broken.write_bytes(echoes.read_bytes())
    with h5py.File(broken, "r+") as file:
        file["history/samples"][5, 7] = np.nan
    assert "are NaN or infinite" in refused(capsys, "image", broken, tmp_path / "out.h5")


def test_a_line_of_sight_that_stands_still_is_refused(capsys, echoes, tmp_path):
    still = tmp_path / "still.h5"
    still.write_bytes(echoes.read_bytes())
    with h5py.File(still, "r+") as file:
        file["track/line_of_sight"][...] = [1.0, 0.0, 0.0]
        file["track/line_of_sight_rate_per_s"][...] = 0.0
    assert "stands still" in refused(capsys, "image", still, tmp_path / "out.h5")


def test_fewer_than_two_views_are_refused(capsys):
    assert "at least 2 views, got 1" in refused(capsys, "experiment", "wide", "--views", 1)


def test_a_port_in_use_is_named(capsys):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        assert str(port) in refused(capsys, "serve", "--port", port)


def test_the_temple_needs_its_photographs(capsys, tmp_path):
    assert "--data FOLDER" in refused(capsys, "experiment", "temple")
    assert str(tmp_path) in refused(capsys, "experiment", "temple", "--data", tmp_path)
