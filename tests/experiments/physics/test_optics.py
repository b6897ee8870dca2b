from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest

from core.experiments.physics.optics import SEARCH_FROM_UTC, visible_pass
from core.experiments.physics.optics_checks import (
    Curve,
    essential_residual,
    full_width,
    photon_transfer,
    sun_error_deg,
)
from core.experiments.physics.optics_outlines import (
    agreement,
    area_error_percent,
    random_frames,
    sunward_errors_px,
)
from core.experiments.physics.optics_pictures import Scene, partner_picture, pass_picture
from core.experiments.pictures import write_pictures
from core.optical.simulation import OpticalSettings
from core.optical.telescope import Detector, Telescope
from core.targets import tiangong_like

TARGET = tiangong_like()


@pytest.fixture(scope="module")
def found():
    return random_frames(
        TARGET,
        phases_rad=np.deg2rad([5.0, 40.0, 50.0]),
        settings=OpticalSettings(
            shape=(200, 200), telescope=Telescope(aperture_m=1.4), supersampling=2
        ),
        random=np.random.default_rng(2),
        progress=lambda _done, _total: None,
    )


def test_the_first_pass_that_a_telescope_sees_is_twelve_days_later():
    each = visible_pass(start_utc=SEARCH_FROM_UTC, days=14)
    assert f"{each.rise_utc:%Y-%m-%d %H:%M}" == "2016-03-24 10:56"
    with pytest.raises(ValueError, match="No pass within 2 days of 2016-03-11"):
        visible_pass(start_utc=datetime(2016, 3, 11, 15, tzinfo=UTC), days=2)


def test_checks_come_out_small():
    random = np.random.default_rng(1)
    assert essential_residual(poses=5, random=random) < 1e-12
    assert sun_error_deg() < 0.01
    photons = photon_transfer(Detector(), random)
    assert photons.measured == pytest.approx(photons.theory, rel=0.03)


def test_the_width_is_read_between_samples():
    at = np.linspace(-3, 3, 61)
    gauss = Curve(at=at, measured=np.exp(-(at**2)), theory=np.exp(-(at**2)))
    assert full_width(gauss) == pytest.approx(2 * np.sqrt(np.log(2)), abs=2e-3)


def test_a_true_outline_has_no_error_and_a_moved_one_its_shift(found):
    perfect = replace(found[0], silhouette=replace(found[0].truth, claim="lit side"))
    assert area_error_percent(perfect) == pytest.approx(0)
    assert np.abs(sunward_errors_px(perfect)).max() < 1e-6
    frame = perfect.frame
    sun = frame.projection.matrix[:, :3] @ frame.sun_direction
    shift = 2.0 * sun / np.linalg.norm(sun)
    rings = tuple(ring + shift for ring in perfect.truth.rings)
    moved = replace(perfect, silhouette=replace(perfect.silhouette, rings=rings))
    assert np.median(sunward_errors_px(moved)) == pytest.approx(2.0)


def test_edges_toward_the_sun_are_found_to_a_pixel(found):
    errors = np.concatenate([sunward_errors_px(each) for each in found])
    assert abs(np.median(errors)) < 0.6
    assert abs(area_error_percent(found[0])) < 8


def test_the_shadow_rule_keeps_what_the_outlines_as_they_stand_carve(found):
    kept, cut = (agreement(found, TARGET, rule, 0.4).coverage for rule in ("shadow", "strict"))
    assert kept > 0.97
    assert cut < kept - 0.1
    assert agreement(found, TARGET, None, 0.4).coverage > 0.99


def test_pictures_are_drawn(found, tmp_path):
    scene = Scene(
        start_utc=SEARCH_FROM_UTC,
        found=(found[0], found[1]),
        radar=found[0],
        partner=found[1],
        rolled=found[2],
    )
    paths = write_pictures((pass_picture(scene), partner_picture(scene)), tmp_path)
    assert [path.name for path in paths] == ["optics-pass.png", "optics-partner.png"]
