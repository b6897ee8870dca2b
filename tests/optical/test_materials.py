import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.optical.materials import Material, facet_materials, part_materials, reflected
from core.targets import tiangong_like


def of_one(material):
    target = tiangong_like()
    return facet_materials(target, [material] * len(target.parts))


def in_plane(angle):
    return np.stack([np.sin(angle), 0 * angle, np.cos(angle)], axis=-1)


@settings(max_examples=30)
@given(
    diffuse=st.floats(0, 0.5, allow_subnormal=False),
    specular=st.floats(0, 0.5, allow_subnormal=False),
    shininess=st.floats(5, 500),
    incidence=st.floats(0, 1.5),
)
def test_no_more_light_leaves_than_comes(diffuse, specular, shininess, incidence):
    """Radiance is π times reflectance times cos i; the hemisphere gets its share of cos i."""
    material = Material(name="any", diffuse=diffuse, specular=specular, shininess=shininess)
    cosine, turn = np.meshgrid(
        (np.arange(150) + 0.5) / 150, np.arange(120) * 2 * np.pi / 120, indexing="ij"
    )
    sine = np.sqrt(1 - cosine**2)
    to_eye = np.stack([sine * np.cos(turn), sine * np.sin(turn), cosine], axis=-1).reshape(-1, 3)
    normal = np.broadcast_to([0.0, 0, 1], to_eye.shape)
    facet = np.zeros(len(to_eye), dtype=np.intp)
    radiance = reflected(of_one(material), facet, normal, in_plane(np.float64(incidence)), to_eye)
    leaving = np.mean(radiance * to_eye[:, 2]) * 2 * np.pi / np.pi
    assert leaving <= (diffuse + specular) * np.cos(incidence) * 1.02 + 1e-9
    assert leaving >= diffuse * np.cos(incidence) * 0.98


def test_at_normal_incidence_the_specular_share_leaves():
    material = Material(name="mirror-like", diffuse=0.0, specular=1.0, shininess=200.0)
    angle = (np.arange(4000) + 0.5) * np.pi / 2 / 4000
    eye = in_plane(angle)
    facet = np.zeros(len(eye), dtype=np.intp)
    up = np.array([0.0, 0, 1])
    radiance = reflected(of_one(material), facet, np.broadcast_to(up, eye.shape), up, eye)
    leaving = np.sum(radiance * np.cos(angle) * np.sin(angle)) * 2 * np.pi / np.pi
    assert leaving * np.pi / 2 / 4000 == pytest.approx(1, abs=0.005)


def test_the_highlight_stands_in_the_mirror_direction():
    material = Material(name="cells", diffuse=0.08, specular=0.12, shininess=300.0)
    angle = np.linspace(-1.5, 1.5, 3001)
    eye = in_plane(angle)
    facet = np.zeros(len(eye), dtype=np.intp)
    normal = np.broadcast_to([0.0, 0, 1], eye.shape)
    radiance = reflected(of_one(material), facet, normal, in_plane(np.float64(-0.6)), eye)
    assert angle[np.argmax(radiance)] == pytest.approx(0.6, abs=0.01)
    assert radiance[np.abs(angle - 0.6) > 0.6].max() == pytest.approx(0.08 * np.cos(0.6), rel=0.01)


def test_every_facet_has_its_parts_material():
    target = tiangong_like()
    materials = facet_materials(target, part_materials(target))
    body, *panels = (len(part.faces) for part in target.parts)
    assert np.all(materials.diffuse[:body] > 0.5)
    assert np.all(materials.diffuse[body:] < 0.1)
    assert len(materials.shininess) == body + sum(panels)


def test_impossible_materials_are_refused():
    with pytest.raises(ValueError, match="nor exceed 1"):
        Material(name="lamp", diffuse=0.9, specular=0.2)
    with pytest.raises(ValueError, match="has 3 parts and 1 materials"):
        facet_materials(tiangong_like(), [Material(name="grey", diffuse=0.2)])
