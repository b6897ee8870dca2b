"""Meshes whose radar cross-section the textbooks give."""

import numpy as np
import trimesh


def mesh(corners, faces):
    return trimesh.Trimesh(np.array(corners, dtype=float), faces, process=False)


def plate(side_m=1.0):
    """A square across z that looks towards +z."""
    half = side_m / 2
    corners = [[-half, -half, 0], [half, -half, 0], [half, half, 0], [-half, half, 0]]
    return mesh(corners, [[0, 1, 2], [0, 2, 3]])


def dihedral(side_m=1.0, length_m=1.0):
    """Two plates that meet at a right angle along z and look towards +x and +y."""
    a, b = side_m, length_m / 2
    corners = [[0, 0, -b], [a, 0, -b], [a, 0, b], [0, 0, b], [0, a, -b], [0, a, b]]
    return mesh(corners, [[0, 2, 1], [0, 3, 2], [0, 4, 5], [0, 5, 3]])


def trihedral(side_m=1.0):
    """Three right triangles that meet at the origin, open towards +x, +y and +z."""
    a = side_m
    return mesh([[0, 0, 0], [a, 0, 0], [0, a, 0], [0, 0, a]], [[0, 1, 2], [0, 2, 3], [0, 3, 1]])
