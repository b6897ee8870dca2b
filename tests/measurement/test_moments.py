import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from core.hull.closed_mesh import Surface
from core.measurement.lines import body_covariance_m5
from core.measurement.parts import part_labels
from tests.measurement.bodies import SHIFTS, TURNS, box, cylinder, joined, moved

BODY = joined(box((4, 2, 1)), cylinder(radius=0.5, length=8.0, sections=16))


@settings(max_examples=20, deadline=None)
@given(turn=TURNS, shift=SHIFTS)
def test_moments_are_those_summed_plainly_over_the_tetrahedra(turn, shift):
    surface = moved(BODY, turn, shift)
    a, b, c = (surface.vertices_m[surface.faces[:, corner]] for corner in range(3))
    sixfold = np.einsum("ij,ij->i", a, np.cross(b, c))
    volume = sixfold.sum() / 6
    centroid = sixfold @ (a + b + c) / 24 / volume
    second = sum(p.T @ (p * sixfold[:, None]) for p in (a, b, c, a + b + c)) / 120
    found, covariance = body_covariance_m5(surface)
    np.testing.assert_allclose(found, centroid, atol=1e-9)
    np.testing.assert_allclose(
        covariance, second - volume * np.outer(centroid, centroid), atol=1e-6
    )


@settings(max_examples=50, deadline=None)
@given(
    st.lists(
        st.lists(st.integers(0, 29), min_size=3, max_size=3, unique=True), min_size=1, max_size=25
    )
)
def test_parts_are_those_of_the_graph_of_all_vertices(faces):
    surface = Surface(vertices_m=np.zeros((30, 3)), faces=np.array(faces))
    a, b, c = surface.faces.T
    ones, pairs = np.ones(2 * len(a)), (np.concatenate([a, b]), np.concatenate([b, c]))
    _, labels = connected_components(coo_array((ones, pairs), shape=(30, 30)), directed=False)
    found, wanted = part_labels(surface), labels[a]
    np.testing.assert_array_equal(found[:, None] == found, wanted[:, None] == wanted)
    assert sorted(set(found.tolist())) == list(range(found.max() + 1))
