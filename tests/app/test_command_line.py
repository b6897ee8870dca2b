import errno
import json
import re
import socket
from dataclasses import replace

import h5py
import numpy as np
import pytest
import trimesh

from app.command_line import main
from app.sources import pass_source
from core.formats.pass_file import RecordedPass, read_pass, write_pass
from core.radar.autofocus import image_entropy
from core.radar.intervals import divide


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


@pytest.fixture(scope="module")
def one_frame(echoes, tmp_path_factory):
    """The echoes' first coherent interval alone, and the pass file of its one frame."""
    folder = tmp_path_factory.mktemp("one")
    history, frames = read_pass(echoes).history, folder / "frames.h5"
    alone = folder / "echoes.h5"
    write_pass(alone, RecordedPass(history=history.part(0, next_interval(history))))
    main(["image", str(alone), str(frames)])
    return alone, frames


def next_interval(history):
    """Where the first coherent interval ends, with a few pulses to spare."""
    (first, *_) = divide(
        history.track, wavelength_m=history.wavelength_m, cross_range_resolution_m=0.15
    )
    return first.stop + 3


def test_echoes_are_focused_on_request(capsys, one_frame, tmp_path):
    alone, plain = one_frame
    out = tmp_path / "focused.h5"
    words = ("--align", "--autofocus", "phase-gradient", "--json", "-")
    facts = json.loads(run(capsys, "image", alone, out, *words))
    assert (facts["autofocus"], facts["aligned"], facts["frames"]) == ("phase-gradient", True, 1)
    focused, before = (read_pass(path).frames[0].amplitude for path in (out, plain))
    assert image_entropy(focused) == pytest.approx(image_entropy(before), rel=0.03)
    assert not np.array_equal(focused, before)
    np.testing.assert_array_equal(read_pass(out).history.samples, read_pass(alone).history.samples)


def test_overlapping_intervals_are_not_focused(capsys, echoes, tmp_path):
    words = ("--overlap", "0.5", "--autofocus", "phase-gradient")
    assert "must not overlap" in refused(capsys, "image", echoes, tmp_path / "out.h5", *words)


COMMANDS = ("serve", "simulate", "import", "image", "reconstruct", "measure", "experiment")


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_readable_help(capsys, command):
    with pytest.raises(SystemExit) as ended:
        main([command, "--help"])
    assert ended.value.code == 0
    out = capsys.readouterr().out
    assert "--help" in out
    assert "None" not in out
    assert "000000" not in out


def test_the_help_names_every_command_and_requires_none(capsys):
    out = run(capsys, "--help")
    assert all(command in out for command in COMMANDS)
    assert "required" not in out


def test_the_version_is_told(capsys):
    assert run(capsys, "--version").startswith("radarhull ")


@pytest.mark.parametrize(
    ("words", "wanted"),
    [
        ("fly", 'there is no command "fly", only serve, .*; see radarhull --help'),
        ("simulate", r"missing: OUT .*; see radarhull simulate --help"),
        ("serve --rule loose", r"invalid choice 'loose' .*\('shadow', 'strict'\); see"),
    ],
)
def test_what_is_not_understood_is_said_in_one_line(capsys, words, wanted):
    assert re.search(wanted, refused(capsys, *words.split()))


@pytest.mark.parametrize(
    ("words", "wanted"),
    [
        ("--start 9999-12-31", "from 1957 to 2056"),
        ("--start 0001-01-01T00:00+05:00", "A time reads like"),
        ("--prf-hz 1e9", r"pulses of 256 frequencies need [\d,.]+ GiB; .* at most \d+ GiB"),
        ("--frequency-count 1000000000", "frequencies need .* GiB"),
        ("--height-m nan", "stands within ±100 km"),
        ("--snr-db nan", "--snr-db wants decibels"),
        ("--snr-db -100000", "--snr-db wants decibels"),
        ("--seed -1", "--seed wants a whole number from 0 on"),
        ("--carrier-hz 0", "must be a positive frequency in hertz, got 0"),
        ("--model mixed --roughness 1.2", "0 to 1; got 1.2"),
        ("--model physical-optics --bounces 0", "at least 1 bounces"),
        ("--scatterers 0", "At least 1 scatterer"),
        ("--phase-error-rad -0.1", "--phase-error-rad wants an rms error"),
        ("--range-error-m inf", "--range-error-m wants an rms error"),
        ("--range-drift-m nan", "--range-drift-m wants metres"),
        ("--json /nonexistent/facts.json", "no folder /nonexistent"),
    ],
)
def test_options_that_cannot_work_are_refused_before_the_work(capsys, tmp_path, words, wanted):
    assert re.search(wanted, refused(capsys, "simulate", tmp_path / "out.h5", *words.split()))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("error", "wanted"),
    [
        (MemoryError("Unable to allocate 2.62 TiB"), "memory does not suffice: Unable to allo"),
        (OSError(errno.ENOSPC, "long text"), "No space left on device"),
        (PermissionError(errno.EACCES, "denied", "secret.h5"), "secret.h5: Permission denied"),
    ],
)
def test_what_the_system_refuses_is_one_line(capsys, monkeypatch, error, wanted):
    def broken(*_):
        raise error

    monkeypatch.setattr("app.command_line._run", broken)
    assert wanted in refused(capsys, "serve")


def test_echoes_become_frames_become_a_hull(capsys, echoes, tmp_path):
    framed, hull = tmp_path / "frames.h5", tmp_path / "hull.glb"
    picture = tmp_path / "frame.png"
    options = ("--picture", picture, "--json", "-")
    made = json.loads(run(capsys, "image", echoes, framed, *options))
    assert (made["shape"], made["spacing_m"], made["frequencies"]) == ([512, 512], 0.06, 256)
    assert picture.stat().st_size > 10_000
    count = len(read_pass(framed).frames)
    assert made["frames"] == count >= 4
    # One short pass bounds no extent, so the grid must: what counts is that all agree.
    out = run(capsys, "reconstruct", framed, "--out", hull, "--json", "-", "--spacing-m", 0.3)
    facts = json.loads(out)
    assert facts["frames"] == facts["views"] == count == facts["threshold"]
    assert (facts["lines"], facts["notes"]) == ([], [])
    assert facts["unobserved_direction"] is not None
    assert facts["volume_m3"] is None
    extents = trimesh.load(hull, force="mesh").extents
    for extent, side_m in zip(facts["extents"], extents, strict=True):
        assert extent["value_m"] in (None, pytest.approx(side_m))
    assert facts["registration"] is None
    assert "not bounded" in run(capsys, "reconstruct", framed, "--spacing-m", 0.5)
    register = ("--spacing-m", 0.5, "--register", "centroid")
    assert "px a frame, and jump by" in run(capsys, "reconstruct", framed, *register)
    shifts = json.loads(run(capsys, "reconstruct", framed, *register, "--json", "-"))[
        "registration"
    ]
    assert shifts["rule"] == "centroid"
    assert [each["frame"] for each in shifts["frames"]] == list(range(1, count + 1))


def test_measured_echoes_are_imported_and_focused(capsys, shared_data, tmp_path):
    files = sorted((shared_data("gotcha")).glob("*.mat"))
    passed, framed = tmp_path / "gotcha.h5", tmp_path / "focused.h5"
    assert "469 pulses × 424 frequencies" in run(capsys, "import", *files, "--out", passed)
    told = json.loads(run(capsys, "import", *files, "--out", passed, "--json", "-"))
    assert (told["pulses"], told["frequencies"], told["file"]) == (469, 424, str(passed))
    options = ("--method", "backprojection", "--pixels", 128, "--pixel-spacing-m", 0.2)
    run(capsys, "image", passed, framed, *options)
    (frame,) = read_pass(framed).frames
    assert frame.shape == (128, 128)


def test_every_method_gives_the_same_intervals(capsys, one_frame, tmp_path):
    echoes, out = one_frame[0], tmp_path / "out.h5"
    seen = []
    for method in ("polar", "keystone", "range-doppler", "backprojection"):
        options = ("--method", method, "--divide", "yes", "--pixels", 64, "--oversampling", 2)
        told = json.loads(run(capsys, "image", echoes, out, *options, "--json", "-"))
        assert (told["method"], told["frames"], told["column_spacing_m"]) == (method, 1, 0.075)
        (frame,) = read_pass(out).frames
        seen.append(frame.amplitude)
        assert frame.column_spacing_m == 0.075
    polar, keystone, _, backprojected = seen
    for other in (keystone, backprojected):
        assert np.abs(other - polar).max() < 0.03 * polar.max()


def test_verdicts_are_told_and_written(capsys, echoes, tmp_path):
    out = tmp_path / "out.h5"
    sharp = ("--target-radius-m", 8.7, "--coarsest-resolution-m", 0.28, "--window", "taylor")
    sharp = (*sharp, "--pixels", 64)
    said = run(capsys, "image", echoes, out, *sharp)
    assert re.search(r"Of \d+ intervals: 0 accepted, \d+ shortened, \d+ rejected", said)
    assert re.search(r"Unsuitable from .* s, zenith part: θ̈ and φ̈ make .* more than π/4", said)
    told = json.loads(run(capsys, "image", echoes, out, *sharp, "--json", "-"))
    assert told["window"] == "taylor -35 dB nbar 5"
    statuses = [interval["status"] for interval in told["intervals"]]
    assert told["verdicts"] == {
        status: statuses.count(status) for status in ("accepted", "shortened", "rejected")
    }
    assert told["frames"] == len(statuses) - statuses.count("rejected")
    assert {part["part"] for part in told["unsuitable"]} == {
        "zenith part",
        "unevenly turning part",
    }
    by_bending = (*sharp, "--criterion", "bending", "--json", "-")
    told = json.loads(run(capsys, "image", echoes, out, *by_bending))
    assert told["verdicts"]["rejected"] == 0
    line = refused(capsys, "image", echoes, out, "--target-radius-m", 20)
    assert "unambiguous in range over 38.4 m only" in line


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
    assert list(tmp_path.iterdir()) == [broken]


def test_a_line_of_sight_that_stands_still_is_refused(capsys, echoes, tmp_path):
    still = tmp_path / "still.h5"
    still.write_bytes(echoes.read_bytes())
    with h5py.File(still, "r+") as file:
        file["track/line_of_sight"][...] = [1.0, 0.0, 0.0]
        file["track/line_of_sight_rate_per_s"][...] = 0.0
    assert "stands still" in refused(capsys, "image", still, tmp_path / "out.h5")
    assert list(tmp_path.iterdir()) == [still]


def test_fewer_than_two_views_are_refused(capsys, one_frame):
    assert "at least 2 views, got 1" in refused(capsys, "experiment", "wide", "--views", 1)
    for path in one_frame:
        for command in ("reconstruct", "serve"):
            line = refused(capsys, command, path)
            assert f"at least 2 views; {path} gives 1" in line


def test_two_files_of_one_frame_each_make_two_views(capsys, one_frame):
    _, frames = one_frame
    out = run(capsys, "reconstruct", frames, frames, "--spacing-m", 0.5)
    assert "Hull of 2 views, 2 votes" in out


def test_frames_without_a_target_do_not_count_as_views(capsys, one_frame, tmp_path):
    _, frames = one_frame
    (frame,) = read_pass(frames).frames
    noise = np.random.default_rng(1).rayleigh(1.0, frame.shape)
    path = tmp_path / "noise.h5"
    write_pass(path, RecordedPass(frames=(frame, replace(frame, amplitude=noise))))
    with pytest.raises(SystemExit):
        main(["reconstruct", str(path), "--spacing-m", "0.5"])
    err = capsys.readouterr().err
    assert "radarhull: note: frame 2 shows no target and does not vote.\n" in err
    assert "at least 2 views; 1 of 2 frames show a target" in err


@pytest.mark.parametrize(
    ("spacing_m", "said"),
    [
        (0, "positive metres, got 21.0 and 0.0"),
        ("nan", "positive metres, got 21.0 and nan"),
        (0.01, "would need 52 GiB; at most 1,073,741,824 fit. Use a larger spacing"),
        (0.001, "would need 8,625 GiB; at most 68,719,476,736 can be carved. Use a larger spacing"),
        (1e-12, "Use a larger spacing"),
    ],
)
def test_grids_that_cannot_be_are_refused(capsys, one_frame, spacing_m, said):
    frames = one_frame[1], one_frame[1]
    assert said in refused(capsys, "reconstruct", *frames, "--spacing-m", spacing_m)


def test_misses_are_views(capsys, one_frame):
    line = refused(capsys, "reconstruct", one_frame[1], "--tolerated-misses", -1)
    assert "--tolerated-misses wants the number of views" in line
    assert "--tolerated-misses" in refused(capsys, "serve", "--tolerated-misses", -1)


@pytest.mark.parametrize(
    ("words", "wanted"),
    [
        ("wide --data X", "wide experiment has no use for --data"),
        ("temple --views 5 --seed 2", "temple experiment has no use for --views, --seed"),
    ],
)
def test_options_of_the_other_experiment_are_refused(capsys, words, wanted):
    assert wanted in refused(capsys, "experiment", *words.split())


@pytest.mark.parametrize(
    ("words", "wanted"),
    [
        ("image {pass} {out}/out.h5 --oversampling 0.2", "1 to 64; got 0.2"),
        ("image {pass} {out}/out.h5 --oversampling 2 --column-spacing-m 1", "not both"),
        ("image {pass} {out}/out.h5 --target-radius-m 5 --divide no", "with --divide yes"),
        ("image {pass} {out}/out.h5 --window taylor --taylor-nbar 1", "nbar of 2 to 20"),
        ("image {pass} {out}/out.h5 --picture {out}/p.jpg", "must end in .png"),
        ("image {pass} {out}/out.h5 --json {out}/no/a.json", "no folder"),
        ("image {pass} {out}/out.txt", "must end in .h5, .hdf5"),
        ("reconstruct {pass} --out {out}/a.xyz", "must end in .glb, .ply, .stl"),
        ("reconstruct {pass} --out {out}/a.glb --json {out}/no/a.json", "no folder"),
        ("simulate {out}/no/o.h5", "no folder"),
        ("import {pass} --out {out}/no/o.h5", "no folder"),
        ("experiment wide --json {out}", "is a folder"),
    ],
)
def test_outputs_are_checked_before_the_work(capsys, echoes, tmp_path, words, wanted):
    named = [word.format(out=tmp_path, **{"pass": echoes}) for word in words.split()]
    assert wanted in refused(capsys, *named)
    assert list(tmp_path.iterdir()) == []


def test_a_simulation_is_summarised_for_machines(capsys, tmp_path):
    out, facts = tmp_path / "out.h5", tmp_path / "facts.json"
    options = ("--mask-deg", 41, "--scatterers", 200, "--frequency-count", 192, "--json", facts)
    assert str(out) in run(capsys, "simulate", out, *options)
    told, history = json.loads(facts.read_text()), read_pass(out).history
    assert (told["pulses"], told["frequencies"]) == history.samples.shape
    assert history.samples.shape[1] == 192
    assert told["epoch_utc"] == history.track.epoch_utc


def test_a_pass_of_a_mirror_is_simulated_with_errors(capsys, tmp_path):
    words = ("--mask-deg", 42.0, "--frequency-count", 192, "--model", "mixed", "--prf-hz", 5)
    rough = ("--roughness", 0.2, "--scatterers", 500, "--bounces", 1)
    clean, shaken = tmp_path / "clean.h5", tmp_path / "shaken.h5"
    told = json.loads(run(capsys, "simulate", clean, *words, *rough, "--json", "-"))
    assert (told["model"], told["roughness"], told["bounces"]) == ("mixed", 0.2, 1)
    run(capsys, "simulate", shaken, *words, *rough, "--phase-error-rad", 0.5, "--range-drift-m", 1)
    before, after = (read_pass(path).history for path in (clean, shaken))
    turn = np.angle(after.samples / before.samples)
    wavenumber = 4 * np.pi / 299_792_458.0 * before.frequency_hz
    drift = np.linspace(-1, 1, len(turn)) ** 2
    phase = np.exp(1j * (turn + np.outer(drift, wavenumber)))
    # What the drift leaves is one random phase per pulse.
    assert np.abs(phase - phase[:, :1]).max() < 1e-3
    assert np.std(np.angle(phase[:, 0])) == pytest.approx(0.5, rel=0.3)


def test_a_port_in_use_is_named(capsys):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        assert str(port) in refused(capsys, "serve", "--port", port)


def test_the_temple_needs_its_photographs(capsys, tmp_path):
    assert "--data FOLDER" in refused(capsys, "experiment", "temple")
    assert str(tmp_path) in refused(capsys, "experiment", "temple", "--data", tmp_path)


def test_telescope_frames_go_beside_the_echoes_and_stay_when_they_are_imaged(tmp_path):
    simulated, imaged = tmp_path / "dusk.h5", tmp_path / "imaged.h5"
    when = [
        "--start",
        "2016-03-24T10:00:00",
        "--mask-deg",
        "30",
        "--prf-hz",
        "60",
        "--frequency-count",
        "256",
    ]
    main(["simulate", str(simulated), "--scatterers", "300", "--optical", "2", *when])
    recorded = read_pass(simulated)
    assert [frame.sensor for frame in recorded.frames] == ["optical", "optical"]
    words = ["--pixels", "256", "--pixel-spacing-m", "0.12", "--resolution-m", "0.6"]
    main(["image", str(simulated), str(imaged), *words])
    sensors = [frame.sensor for frame in read_pass(imaged).frames]
    assert sensors.count("optical") == 2
    assert sensors.count("radar") > 2
    assert pass_source(simulated).expected_frames > 2


def test_no_telescope_sees_a_target_in_the_earths_shadow(tmp_path, capsys):
    words = ["--scatterers", "30", "--optical", "2", "--mask-deg", "38"]
    with pytest.raises(SystemExit) as ended:
        main(["simulate", str(tmp_path / "night.h5"), *words])
    assert ended.value.code == 2
    assert "Earth's shadow" in capsys.readouterr().err
    assert not (tmp_path / "night.h5").exists()


def test_the_workstation_does_not_wait_for_all_frames(capsys):
    assert "waits for all frames" in refused(capsys, "serve", "--register", "agreement")


def test_the_workstation_begins_with_a_pass_or_without(capsys):
    assert "begins without a source" in refused(capsys, "serve", "pass.h5", "--empty")


def test_a_reference_that_is_no_mesh_is_named_before_anything_starts(capsys, tmp_path) -> None:
    assert "There is no mesh file" in refused(capsys, "serve", "--reference", tmp_path / "a.stl")


def test_a_references_attitude_that_turns_nothing_is_refused(capsys, tmp_path) -> None:
    file = tmp_path / "box.stl"
    trimesh.creation.box((1.0, 1.0, 1.0)).export(file)
    options = ["--reference", file, "--reference-attitude", "0", "0", "0", "0"]
    assert "--reference-attitude wants a quaternion w x y z" in refused(capsys, "serve", *options)
