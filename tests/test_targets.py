import numpy as np
import pytest

from core.targets import mro_like


def test_the_orbiter_has_the_three_lines_of_the_paper_from_tip_to_tip():
    target = mro_like()
    points = target.mesh().vertices
    lines = {feature.name: feature for feature in target.features}
    assert [line.length_m for line in target.features] == [27.69, 58.12, 15.88]
    for name in ("l2", "l3"):
        assert np.ptp(points @ lines[name].direction) == pytest.approx(lines[name].length_m)
    boom = next(
        part
        for part in target.parts
        if np.ptp(part.vertices @ lines["l1"].direction) == pytest.approx(27.69)
    )
    across = boom.vertices - boom.centroid
    across -= np.outer(across @ lines["l1"].direction, lines["l1"].direction)
    assert np.linalg.norm(across, axis=1).max() < 0.3


def test_the_orbiter_is_of_closed_parts_and_differs_from_its_mirror_image():
    target = mro_like()
    assert all(part.is_watertight and part.volume > 0 for part in target.parts)
    assert len(target.mesh().split()) == len(target.parts)
    for axis in range(3):
        mirrored = target.mesh().vertices * np.where(np.arange(3) == axis, -1, 1)
        gaps = np.linalg.norm(target.mesh().vertices[:, None] - mirrored[None], axis=2).min(axis=1)
        assert gaps.max() > 0.5
