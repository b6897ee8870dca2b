import numpy as np
import pytest

from core.experiments.physics.registration import registration_part
from core.experiments.pictures import write_pictures


@pytest.fixture(scope="module")
def part():
    return registration_part(
        lambda *_: None, views=20, scatterers=5_000, demo_scatterers=0, spacing_m=0.5
    )


def value(part, name):
    return next(figure.value for figure in part.figures if figure.name == name)


def test_agreement_is_far_better_than_the_centroid(part):
    agreement = value(part, "residual per axis")
    # Twenty views at a sixth of the scatterers; eighty of the full part leave less than 0.5 px.
    assert agreement < 1.5
    assert value(part, "residual per axis, centroid alone") > 5 * agreement
    assert value(part, "residual, both axes together") == pytest.approx(np.sqrt(2) * agreement)
    assert value(part, "hull IoU, by agreement") > 2 * value(part, "hull IoU, by centroid alone")


def test_bad_silhouettes_move_the_good_frames_little(part):
    spoilt = value(part, "residual per axis of good frames, 10 % bad silhouettes")
    assert spoilt < 2 * value(part, "residual per axis") + 0.2


def test_what_was_asked_has_a_target(part):
    wanted = {figure.name: figure.wanted for figure in part.figures if figure.wanted}
    assert wanted == {
        "residual per axis": "<= 0.5 px",
        "hull IoU, difference to the registered one": "<= 0.02",
        "residual per axis of good frames, 10 % bad silhouettes": "<= 0.5 px",
    }


def test_its_pictures_can_be_drawn(part, tmp_path):
    paths = write_pictures(part.pictures, tmp_path)
    assert [path.stem for path in paths] == ["registration-offsets", "registration-residuals"]
