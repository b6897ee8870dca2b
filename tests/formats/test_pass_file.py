import h5py
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from core.formats.pass_file import RecordedPass, read_pass, write_pass
from core.frame import Frame
from core.geometry.projection import Projection
from core.geometry.track import random_views_track
from core.radar.phase_history import PhaseHistory


def recorded(seed=0, *, pulses=12, frames=2, with_range=True):
    random = np.random.default_rng(seed)
    track = random_views_track(
        views=2,
        turn_rad=0.06,
        pulses_per_view=pulses // 2,
        pulse_repetition_frequency_hz=100.0,
        random=random,
    )
    if with_range:
        object.__setattr__(track, "range_m", random.uniform(1e5, 2e5, pulses))
        object.__setattr__(track, "bisector_scale", random.uniform(0.5, 1, pulses))
        object.__setattr__(track, "epoch_utc", "2016-03-11T17:12:17Z")
    samples = random.normal(size=(pulses, 8)) + 1j * random.normal(size=(pulses, 8))
    return RecordedPass(
        history=PhaseHistory(
            samples=samples, frequency_hz=np.linspace(16e9, 17e9, 8), track=track, sensor="R1"
        ),
        frames=tuple(frame(random, number) for number in range(frames)),
    )


def frame(random, number):
    return Frame(
        amplitude=random.uniform(0, 1, (5, 6)),
        projection=Projection(matrix=random.normal(size=(2, 4))),
        time_s=float(number),
        sensor="radar",
        line_of_sight=[0.6, 0.0, 0.8],
        row_spacing_m=0.06,
        column_spacing_m=0.05,
        row_resolution_m=0.2,
        label=f"frame {number}",
        window=("hamming", "taylor -40 dB nbar 6")[number % 2],
    )


@settings(max_examples=15, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(seed=st.integers(0, 2**32 - 1), frames=st.integers(0, 3), with_range=st.booleans())
def test_reading_what_was_written_gives_the_same(tmp_path, seed, frames, with_range):
    before = recorded(seed, frames=frames, with_range=with_range)
    path = tmp_path / "pass.h5"
    write_pass(path, before)
    after = read_pass(path)
    assert np.array_equal(after.history.samples, before.history.samples)
    assert np.array_equal(after.history.frequency_hz, before.history.frequency_hz)
    assert after.history.sensor == "R1"
    for name in (
        "time_s",
        "line_of_sight",
        "line_of_sight_rate_per_s",
        "range_m",
        "bisector_scale",
    ):
        assert np.array_equal(
            getattr(after.history.track, name), getattr(before.history.track, name)
        )
    assert after.history.track.epoch_utc == before.history.track.epoch_utc
    for ours, theirs in zip(after.frames, before.frames, strict=True):
        assert np.array_equal(ours.amplitude, theirs.amplitude)
        assert np.array_equal(ours.projection.matrix, theirs.projection.matrix)
        for name in ("time_s", "sensor", "label", "window", "row_spacing_m", "column_resolution_m"):
            assert getattr(ours, name) == getattr(theirs, name)


@pytest.fixture
def written(tmp_path):
    path = tmp_path / "pass.h5"
    write_pass(path, recorded())
    return path


def test_writing_leaves_nothing_but_the_file(written):
    assert list(written.parent.iterdir()) == [written]


def test_a_file_cut_in_half_is_refused(written):
    whole = written.read_bytes()
    written.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(ValueError, match="cut short or damaged; copy it again"):
        read_pass(written)


def test_a_file_that_is_something_else_is_refused(tmp_path):
    path = tmp_path / "pass.h5"
    path.write_text("not HDF5")
    with pytest.raises(ValueError, match="its signature is missing"):
        read_pass(path)
    with pytest.raises(ValueError, match="There is no file"):
        read_pass(tmp_path / "absent.h5")


def test_another_hdf5_file_is_refused(tmp_path):
    path = tmp_path / "other.h5"
    with h5py.File(path, "w") as file:
        file["x"] = [1, 2]
    with pytest.raises(ValueError, match='its attribute "format" is "", wanted "radarhull pass"'):
        read_pass(path)


def test_a_newer_schema_is_refused(written):
    with h5py.File(written, "r+") as file:
        file.attrs["schema_version"] = 99
    with pytest.raises(ValueError, match="schema version 99"):
        read_pass(written)


def test_nan_echoes_are_refused(written):
    with h5py.File(written, "r+") as file:
        file["history/samples"][3, 2] = np.nan
    with pytest.raises(ValueError, match="Echoes: 1 of 96 values are NaN"):
        read_pass(written)


def test_a_missing_dataset_is_named(written):
    with h5py.File(written, "r+") as file:
        del file["history/frequency_hz"]
    with pytest.raises(ValueError, match="/history/frequency_hz with real numbers is missing"):
        read_pass(written)


def external_link(file, path):
    file["frames/evil"] = h5py.ExternalLink("/etc/passwd", "/x")


def soft_link(file, path):
    file["frames/evil"] = h5py.SoftLink("/history")


def external_storage(file, path):
    file["frames"].create_dataset(
        "evil", shape=(4,), dtype="f4", external=[(str(path.parent / "raw"), 0, 16)]
    )


def virtual_dataset(file, path):
    layout = h5py.VirtualLayout(shape=(4,), dtype="f4")
    layout[:] = h5py.VirtualSource(str(path.parent / "else.h5"), "x", shape=(4,))
    file["frames"].create_virtual_dataset("evil", layout)


def object_reference(file, path):
    references = file["frames"].create_dataset("evil", (1,), dtype=h5py.ref_dtype)
    references[0] = file["history"].ref


def bomb(file, path):
    file["frames"].create_dataset("evil", shape=(2**34,), dtype="f4", chunks=(2**20,))


@pytest.mark.parametrize(
    ("plant", "message"),
    [
        (external_link, "ExternalLink"),
        (soft_link, "SoftLink"),
        (external_storage, "outside the file"),
        (virtual_dataset, "virtual dataset"),
        (object_reference, "not plain numbers"),
        (bomb, r"would unpack to 64\.0 GiB"),
    ],
)
def test_what_points_outside_or_explodes_is_refused(written, plant, message):
    with h5py.File(written, "r+") as file:
        plant(file, written)
    with pytest.raises(ValueError, match=message):
        read_pass(written)


def test_a_pass_without_anything_is_refused():
    with pytest.raises(ValueError, match="neither"):
        RecordedPass()


def test_a_folder_that_does_not_exist_is_named(tmp_path):
    with pytest.raises(ValueError, match="could not be written"):
        write_pass(tmp_path / "absent" / "pass.h5", recorded())


def test_another_unit_is_refused(written):
    with h5py.File(written, "r+") as file:
        file["frames/000000/matrix"].attrs["unit"] = "pixel/km"
    with pytest.raises(ValueError, match='must be in "pixel/m", its unit is "pixel/km"'):
        read_pass(written)


def test_a_dataset_where_a_group_belongs_is_refused(written):
    with h5py.File(written, "r+") as file:
        file["frames/000009"] = [1.0]
    with pytest.raises(ValueError, match="the group /frames/000009 is missing"):
        read_pass(written)


@pytest.mark.parametrize("value", [0.0, -1.0, np.nan])
def test_impossible_spacings_are_refused(written, value):
    with h5py.File(written, "r+") as file:
        file["frames/000000"].attrs["column_spacing_m"] = value
    with pytest.raises(ValueError, match="column_spacing_m must be positive metres"):
        read_pass(written)
