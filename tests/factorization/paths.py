"""Generic paths of the line of sight, and shapes to see along them."""

import numpy as np


def generic_path(frames, random):
    """Return k and dk/dt (frames, 3) along a closed curve of two random harmonics."""
    angle = np.linspace(0, 2 * np.pi, frames, endpoint=False)
    waves = [np.ones(frames), np.cos(angle), np.sin(angle), np.cos(2 * angle), np.sin(2 * angle)]
    slopes = [
        np.zeros(frames),
        -waves[2],
        waves[1],
        -2 * waves[4],
        2 * waves[3],
    ]
    coefficients = random.normal(size=(5, 3))
    curve, slope = np.stack(waves, axis=1) @ coefficients, np.stack(slopes, axis=1) @ coefficients
    return unit_path(curve, slope)


def unit_path(curve, slope):
    """Return the unit vectors along a curve (frames, 3) and their rates, 0.01 rad/s or so."""
    length = np.linalg.norm(curve, axis=1, keepdims=True)
    k = curve / length
    rate = slope / length
    return k, 0.01 * (rate - k * np.sum(k * rate, axis=1, keepdims=True))


def cone_path(frames, sine):
    """Return a turn at a constant angle about z: a plane for sine 0."""
    angle = np.linspace(0, 1.5 * np.pi, frames)
    radius = np.sqrt(1 - sine**2)
    zero = np.zeros(frames)
    curve = np.stack([radius * np.cos(angle), radius * np.sin(angle), zero + sine], axis=1)
    return unit_path(curve, np.stack([-curve[:, 1], curve[:, 0], zero], axis=1))
