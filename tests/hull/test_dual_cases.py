import numpy as np

from core.hull.cube_cases import loops
from core.hull.dual_cases import _passes, parted_loops, sheet_table, twice_passed_table

TWICE = np.flatnonzero(twice_passed_table() >= 0)


def test_every_crossed_edge_is_on_exactly_one_sheet():
    table = sheet_table()
    for case in range(256):
        crossed = {edge for loop in loops(case) for edge in loop}
        for row in (case, 256 + case):
            assert {edge for edge in range(12) if table[row, edge] >= 0} == crossed
            assert set(table[row, :12][table[row, :12] >= 0]) == set(range(table[row, 12]))


def test_a_cube_that_passes_a_face_twice_has_no_other_ambiguous_face():
    """So that joining it the other way splits the loop, and no two such faces interfere."""
    assert len(TWICE) > 0
    for case in TWICE:
        crossings = [sum(len(_passes(loop, face)) for loop in loops(case)) for face in range(6)]
        assert crossings.count(2) == 1


def test_parted_loops_pass_no_face_twice():
    for case in range(256):
        parted = parted_loops(case)
        assert len(parted) == len(loops(case)) + (case in TWICE)
        assert all(len(_passes(loop, face)) < 2 for loop in parted for face in range(6))
        assert all(len(loop) >= 3 for loop in parted)
