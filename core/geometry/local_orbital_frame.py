"""The local orbital frame that an Earth-pointing satellite keeps."""

import numpy as np

from core.arrays import Floats


def lvlh_axes(position_m: Floats, velocity_m_per_s: Floats) -> Floats:
    """Return the LVLH axes as rows of (…, 3, 3) rotations from the inertial frame.

    x points along-track (toward the velocity), y opposite to the orbit normal, z to the
    geocentre.

    Args:
        position_m: (…, 3) inertial.
        velocity_m_per_s: (…, 3) inertial.

    Source: CCSDS 500.0-G-4, "Navigation data: definitions and conventions", LVLH.
    """
    position = np.asarray(position_m, dtype=np.float64)
    normal = np.cross(position, velocity_m_per_s)
    z = -position / np.linalg.norm(position, axis=-1, keepdims=True)
    y = -normal / np.linalg.norm(normal, axis=-1, keepdims=True)
    axes: Floats = np.stack([np.cross(y, z), y, z], axis=-2)
    return axes
