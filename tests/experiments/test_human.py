import numpy as np
import pytest

from core.experiments.human import run_human
from core.experiments.human_knife import bright_part
from core.experiments.pictures import write_pictures
from core.frame import Frame
from core.geometry.projection import Projection
from core.radar.circular_sar import NearFieldSettings
from core.silhouettes.silhouette import Silhouette

SQUARE = Silhouette(
    rings=(np.array([[20.0, 20], [20, 180], [180, 180], [180, 20]]),),
    image_shape=(200, 200),
    claim="lit side",
)


@pytest.fixture(scope="module")
def study():
    few = NearFieldSettings(cross_range_resolution_m=0.02, shape=(192, 80), pixel_spacing_m=0.01)
    return run_human(spacing_m=0.03, scatterers=6_000, pulses=480, imaging=few)


def value(study, name):
    return next(figure.value for figure in study.results.figures if figure.name == name)


def test_the_shadow_rule_keeps_the_body_and_the_strict_one_does_not(study):
    assert value(study, "shadow rule: coverage") > 0.8
    assert value(study, "strict rule: coverage") < 0.5
    assert abs(value(study, "shadow rule: height error")) < 80
    assert abs(value(study, "shadow rule: shoulder width error")) < 60


def test_true_outlines_are_the_floor(study):
    assert value(study, "true outlines: coverage") > 0.98
    assert value(study, "true outlines: IoU") > value(study, "shadow rule: IoU") + 0.1
    assert abs(value(study, "true outlines: knife length error")) < 10
    assert value(study, "true outlines: knife direction error") < 2


def test_the_soles_need_a_circle_below(study):
    _, directions = study.results.tables
    both, above, _ = directions.rows
    assert both[3].startswith("good")
    assert above[3].startswith("unobserved")
    assert "heights are good, from the circle above alone unobserved" in study.results.finding


def test_pictures_and_hull_come_out(study, tmp_path):
    assert study.hull.volume_m3() > 0
    names = [path.stem for path in write_pictures(study.pictures, tmp_path)]
    assert names == ["human-frames", "human-hull", "human-errors"]


def speckled(random, blade_db):
    """A square of speckle with a blade of 20 × 60 pixels in it, 5 mm pixels and 25 mm cells."""
    from scipy.ndimage import gaussian_filter

    level = np.full((200, 200), 1e-3)
    level[20:180, 20:180] = 1.0
    level[90:110, 70:130] = 10 ** (blade_db / 20)
    noise = random.normal(size=(200, 200)) + 1j * random.normal(size=(200, 200))
    field = gaussian_filter((level * noise).real, 2) + 1j * gaussian_filter((level * noise).imag, 2)
    return Frame(
        amplitude=np.abs(field).astype(np.float32),
        projection=Projection(matrix=np.eye(4)[:2] * 200),
        time_s=0.0,
        sensor="radar",
        line_of_sight=np.array([1.0, 0, 0]),
        row_spacing_m=0.005,
        column_spacing_m=0.005,
        row_resolution_m=0.0325,
        column_resolution_m=0.0325,
    )


def test_a_blade_is_found_by_its_brightness_where_it_is():
    found = bright_part(speckled(np.random.default_rng(1), 20.0), SQUARE)
    assert found.component == "knife"
    points = np.concatenate(found.rings)
    assert np.abs(points.mean(axis=0) - (100, 100)).max() < 10
    assert np.ptp(points[:, 1]) == pytest.approx(60, abs=16)


def test_speckle_alone_is_no_blade():
    for seed in range(3):
        assert bright_part(speckled(np.random.default_rng(seed), 0.0), SQUARE).is_empty
