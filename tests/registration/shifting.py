"""Views with known offsets, and what registration leaves of them."""

from dataclasses import replace

import numpy as np

from core.benchmarks.workload import satellite_views
from core.registration.registration import moved


def random_offsets(views, *, seed=1, reach_px=20.0):
    return np.random.default_rng(seed).uniform(-reach_px, reach_px, (len(views), 2))


def shifted(views, offsets_px):
    """The views as they come when their projections know nothing of these offsets."""
    return [
        replace(view, projection=moved(view.projection, -offset))
        for view, offset in zip(views, offsets_px, strict=True)
    ]


def translated(views, translation_m):
    """The views with the whole target moved."""
    return [
        replace(
            view, projection=moved(view.projection, view.projection.matrix[:, :3] @ translation_m)
        )
        for view in views
    ]


def left_px(found_px, true_px, views):
    """What is left (views, 2) after the best translation of the whole target."""
    matrix = np.concatenate([view.projection.matrix[:, :3] for view in views])
    wrong = (found_px - true_px).ravel()
    return (wrong - matrix @ np.linalg.lstsq(matrix, wrong, rcond=None)[0]).reshape(-1, 2)


def rms(values):
    return float(np.sqrt(np.mean(values**2)))


def body_views(count, *, seed=1):
    return list(satellite_views(count, seed=seed, segments=16))
