import numpy as np
import pytest

from core.human_body import SHOULDER_BAND, standing_person


def test_the_body_is_one_closed_solid_of_the_size_asked_for():
    body = standing_person(height_m=1.75, shoulder_width_m=0.44).parts[0]
    assert body.is_watertight
    assert len(body.split()) == 1
    assert np.ptp(body.vertices[:, 2]) == pytest.approx(1.75, abs=1e-6)
    share = 0.5 - body.vertices[:, 2] / 1.75
    band = (share >= SHOULDER_BAND[0]) & (share <= SHOULDER_BAND[1])
    assert np.ptp(body.vertices[band, 1]) == pytest.approx(0.44, abs=1e-6)


def test_the_body_has_the_volume_and_the_surface_of_a_person():
    body = standing_person().parts[0]
    assert 0.05 < body.volume < 0.085  # 50 to 85 kg at the density of water
    assert 1.4 < body.area < 2.1  # Du Bois, 1916: 1.8 m² for 70 kg and 1.75 m


def test_the_feet_are_down_along_z_and_point_forward():
    body = standing_person().parts[0]
    feet = body.vertices[body.vertices[:, 2] > 0.8]
    head = body.vertices[body.vertices[:, 2] < -0.7]
    assert feet[:, 0].max() > 0.12 > -0.12 < feet[:, 0].min()
    assert np.ptp(head[:, 1]) < 0.2


def test_the_knife_lies_before_the_waist_without_touching_the_body():
    person = standing_person(knife_length_m=0.25)
    body, *knife = person.parts
    points = np.concatenate([part.vertices for part in knife])
    (feature,) = (each for each in person.features if each.name == "knife")
    assert np.ptp(points @ feature.direction) == pytest.approx(0.25)
    assert not body.contains(points).any()
    assert body.bounds[0, 1] < points[:, 1].min() < points[:, 1].max() < body.bounds[1, 1]
    assert 0.875 - points[:, 2].mean() == pytest.approx(0.6 * 1.75, abs=0.01)
    assert points[:, 0].min() > 0.05


def test_proportions_of_no_person_are_refused():
    with pytest.raises(ValueError, match="of that wide"):
        standing_person(height_m=1.75, shoulder_width_m=0.9)
