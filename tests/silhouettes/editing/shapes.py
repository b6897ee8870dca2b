"""Outlines and frames that the tests of the editing tools share."""

import numpy as np
import shapely
from hypothesis import strategies as st

from core.frame import Frame
from core.geometry.projection import Projection
from core.silhouettes.areas import area_of, rings_of
from core.silhouettes.contours import traced_rings
from core.silhouettes.silhouette import Silhouette, clockwise_area_px

SHAPE = (48, 60)


def box(first_row, first_column, last_row, last_column):
    return rings_of(shapely.box(first_row, first_column, last_row, last_column))


def disc(row, column, radius, vertices=96):
    angle = np.linspace(0, 2 * np.pi, vertices, endpoint=False)
    return (np.column_stack([row - radius * np.cos(angle), column + radius * np.sin(angle)]),)


def body():
    """Return a plate with a window and a boom beside it."""
    area = shapely.box(10.2, 12.3, 30.7, 40.1).difference(shapely.box(15.1, 20.2, 21.4, 30.6))
    return rings_of(area.union(shapely.box(35.5, 10.5, 38.25, 50.0)))


@st.composite
def outlines(draw):
    """Return rings traced from random blocks: several parts and holes."""
    coarse = draw(st.lists(st.booleans(), min_size=20, max_size=20))
    mask = np.kron(np.reshape(coarse, (4, 5)), np.ones((9, 9))).astype(bool)
    return traced_rings(np.pad(mask, 4).astype(np.float32), 0.5)


def area_px(rings):
    return float(sum(clockwise_area_px(ring) for ring in rings))


def silhouette(rings, image_shape=SHAPE, claim="lit side"):
    return Silhouette(
        rings=rings, image_shape=image_shape, claim=claim, component="boom", provenance="drawn"
    )


def assert_well_turned(rings):
    """Outer rings run clockwise and holes the other way, and none cross."""
    area = area_of(rings)
    assert area.is_valid
    assert np.isclose(area_px(rings), area.area)
    outers = sum(clockwise_area_px(ring) > 0 for ring in rings)
    assert outers == sum(not part.is_empty for part in shapely.get_parts(area))


def hausdorff_px(rings, others):
    """Return the largest distance between two outlines, from points all along their edges."""
    first, second = area_of(rings).boundary, area_of(others).boundary
    return float(
        max(
            shapely.hausdorff_distance(first.segmentize(0.1), second),
            shapely.hausdorff_distance(second.segmentize(0.1), first),
        )
    )


def frame_of(amplitude, *, sensor="radar", spacing_m=0.1, origin_px=None, time_s=0.0):
    amplitude = np.asarray(amplitude, np.float32)
    matrix = np.zeros((2, 4))
    matrix[:, :3] = np.eye(3)[:2] / spacing_m
    matrix[:, 3] = origin_px or (amplitude.shape[0] // 2, amplitude.shape[1] // 2)
    return Frame(
        amplitude=amplitude,
        projection=Projection(matrix=matrix),
        time_s=time_s,
        sensor=sensor,
        line_of_sight=np.array([1.0, 0.0, 0.0]),
        row_spacing_m=spacing_m,
        column_spacing_m=spacing_m,
        row_resolution_m=2 * spacing_m,
        column_resolution_m=2 * spacing_m,
        label="trial",
    )


def coverage(rings, image_shape=SHAPE, finer=8):
    """Return the share of every pixel that the outline covers."""
    fine = tuple(finer * size for size in image_shape)
    scaled = tuple(finer * ring + (finer - 1) / 2 for ring in rings)
    mask = Silhouette(rings=scaled, image_shape=fine, claim="complete").mask()
    rows, columns = image_shape
    return mask.reshape(rows, finer, columns, finer).mean(axis=(1, 3))
