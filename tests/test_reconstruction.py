from dataclasses import replace
from itertools import islice

import numpy as np
import pytest

from core.experiments.wide import simulated_frames
from core.reconstruction import ReconstructionSettings, reconstruct
from core.registration.centroid import centroid_px
from core.registration.registration import Registration, moved
from core.targets import tiangong_like

SETTINGS = ReconstructionSettings(spacing_m=0.4)


@pytest.fixture(scope="module")
def frames():
    return simulated_frames(
        tiangong_like(),
        views=4,
        scatterers=10_000,
        signal_to_noise_db=20.0,
        random=np.random.default_rng(5),
    )


def test_the_hull_only_shrinks(frames):
    volumes = [step.surface.volume_m3() for step in reconstruct(frames, SETTINGS)]
    assert volumes == sorted(volumes, reverse=True)
    assert volumes[-1] > 50


def test_tolerated_misses_lower_the_threshold(frames):
    settings = ReconstructionSettings(spacing_m=0.4, tolerated_misses=1)
    strict = list(reconstruct(frames, SETTINGS))
    soft = list(reconstruct(frames, settings))
    assert [step.threshold for step in soft] == [1, 1, 2, 3]
    assert soft[-1].surface.volume_m3() > strict[-1].surface.volume_m3()


def test_the_strict_rule_carves_what_the_shadow_rule_keeps(frames):
    strict = ReconstructionSettings(spacing_m=0.4, rule="strict")
    kept = list(reconstruct(frames, SETTINGS))[-1].surface.volume_m3()
    assert list(reconstruct(frames, strict))[-1].surface.volume_m3() < 0.8 * kept


def test_registration_by_centroid_puts_the_origin_there(frames):
    settings = ReconstructionSettings(spacing_m=0.4, registration="centroid")
    step = next(iter(reconstruct(frames, settings)))
    at = step.frame.projection.image_points(np.zeros(3))
    assert at == pytest.approx(centroid_px(step.silhouette))


def test_registration_by_agreement_finds_the_offsets():
    true_frames = simulated_frames(
        tiangong_like(),
        views=16,
        scatterers=8_000,
        signal_to_noise_db=20.0,
        random=np.random.default_rng(5),
    )
    offsets = np.random.default_rng(3).uniform(-20, 20, (16, 2))
    moved_by = zip(true_frames, offsets, strict=True)
    came = [replace(frame, projection=moved(frame.projection, -o)) for frame, o in moved_by]
    steps = list(reconstruct(came, ReconstructionSettings(spacing_m=0.8, registration="agreement")))
    matrix = np.concatenate([frame.projection.matrix[:, :3] for frame in came])
    wrong = np.concatenate([step.offset_px for step in steps]) - offsets.ravel()
    left = wrong - matrix @ np.linalg.lstsq(matrix, wrong)[0]
    assert np.sqrt(np.mean(left**2)) < 1.5
    assert steps[0].frame.projection.matrix[:, 3] - came[0].projection.matrix[:, 3] == (
        pytest.approx(steps[0].offset_px)
    )


def test_a_silhouette_without_agreement_is_noted_and_does_not_vote(monkeypatch, frames):
    found = Registration(
        offsets_px=np.zeros((4, 2)),
        residual_px=np.zeros(4),
        is_bad=np.array([False, True, False, False]),
    )
    monkeypatch.setattr("core.reconstruction.registered", lambda _views: found)
    steps = list(reconstruct(frames, replace(SETTINGS, registration="agreement")))
    assert steps[1].note == "frame 2 has a silhouette that contradicts the others and does not vote"
    assert [step.voting for step in steps] == [1, 1, 2, 3]


def test_a_frame_without_a_target_is_noted_and_does_not_vote(frames):
    noise = np.random.default_rng(1).rayleigh(1.0, frames[0].shape)
    blank = replace(frames[0], amplitude=noise)
    before, noted, after = islice(reconstruct([frames[0], blank, frames[1]], SETTINGS), 3)
    assert noted.note == "frame 2 shows no target and does not vote"
    assert (noted.voting, noted.threshold) == (1, 1)
    assert noted.surface.volume_m3() == before.surface.volume_m3()
    assert (after.note, after.voting, after.number) == ("", 2, 3)


def test_lines_are_measured_only_on_closed_hulls(frames):
    assert next(iter(reconstruct(frames, SETTINGS))).lines == ()


def test_a_negative_number_of_misses_is_refused():
    with pytest.raises(ValueError, match="Tolerated misses are a number of views"):
        ReconstructionSettings(tolerated_misses=-1)
