"""Which sheet of the surface each crossed edge of a cube of voxels belongs to.

A loop of `cube_cases.loops` is one sheet; it gets one vertex. The dual of loops that are joined
alike by two cubes that share a face is closed, and every edge of it has two faces but in one case:
two cubes whose loops both pass their common face twice. There the crossings are joined the other
way, so that the inside corners are joined and not each cut off; that splits both loops.

Source: Wenger, "Isosurfaces", 2013, section 3.3.5 (the cubes that have such a face have no other
ambiguous one), with the loops of `cube_cases`.
"""

from functools import cache

import numpy as np
from numpy.typing import NDArray

from core.hull.cube_cases import AXIS_BITS, EDGES, Loop, loops


@cache
def sheet_table() -> NDArray[np.int8]:
    """Return (512, 13): for each edge which loop it is on, −1 where not crossed, and how many.

    Cases from 256 on are those whose loop passes a face twice, with that face joined otherwise.
    """
    table = np.full((512, 13), -1, dtype=np.int8)
    for case in range(256):
        for row, found in ((case, loops(case)), (256 + case, parted_loops(case))):
            for number, loop in enumerate(found):
                table[row, list(loop)] = number
            table[row, 12] = len(found)
    return table


@cache
def twice_passed_table() -> NDArray[np.int8]:
    """Return (256,) the face that one loop passes twice, as 2 · axis + upper, −1 for none."""
    table = np.full(256, -1, dtype=np.int8)
    for case in range(256):
        for loop in loops(case):
            for face in range(6):
                if len(_passes(loop, face)) == 2:
                    table[case] = face
    return table


def parted_loops(case: int) -> tuple[Loop, ...]:
    """Return the loops with the face that one of them passes twice, if any, joined otherwise."""
    face = int(twice_passed_table()[case])
    found: list[Loop] = []
    for loop in loops(case):
        passes = _passes(loop, face) if face >= 0 else []
        if len(passes) == 2:
            first, second = passes
            found += [loop[first + 1 : second + 1], loop[second + 1 :] + loop[: first + 1]]
        else:
            found.append(loop)
    return tuple(found)


def _passes(loop: Loop, face: int) -> list[int]:
    """Return at which places of a loop the step to its next edge lies on a face."""
    on = [_is_on(edge, face) for edge in loop]
    return [i for i in range(len(loop)) if on[i] and on[(i + 1) % len(loop)]]


def _is_on(edge: int, face: int) -> bool:
    bit = AXIS_BITS[face // 2]
    return all(bool(corner & bit) == bool(face % 2) for corner in EDGES[edge])
