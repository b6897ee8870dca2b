import numpy as np

from app.loop_benchmark import drawn_frame, run_loop
from core.benchmarks.workload import satellite_views
from core.silhouettes.extraction import ExtractionSettings, extract_silhouette


def test_a_session_of_edits_reaches_the_viewport_and_the_hull_is_the_one_from_scratch() -> None:
    results = run_loop(sizes=((32, 6),), edits=4, previews=3)
    figures = {figure.name: figure for figure in results.figures}
    median = figures["32³×6: edit to viewport, median"].value
    assert 0 < median <= figures["32³×6: edit to viewport, p95"].value
    assert figures["32³×6: previews shown in a drag"].value > 0
    assert figures["32³×6: hulls that differ from scratch"].value == 0


def test_its_frames_show_the_outlines_they_were_drawn_from() -> None:
    view = satellite_views(1)[0]
    frame = drawn_frame(view, time_s=0.0, random=np.random.default_rng(1))
    found = extract_silhouette(frame, ExtractionSettings(censoring_factor=2.5)).mask()
    truth = view.silhouette.mask()
    assert (found & truth).sum() / (found | truth).sum() > 0.93
