from core.experiments.physics.intervals import intervals_part
from core.experiments.pictures import write_pictures


def test_resolution_is_constant_and_the_zenith_part_is_named(tmp_path):
    part = intervals_part(lambda _stage, _done, _total: None)
    assert [figure.name for figure in part.figures if figure.met is False] == []
    values = {figure.name: figure for figure in part.figures}
    by_angles = values["pass near the zenith: phase that θ̈ and φ̈ make at the culmination"]
    assert by_angles.value > 10
    assert values["pass near the zenith: intervals rejected as its zenith part"].met
    # The verdicts matter: as wanted, the low part of a pass would be out of focus.
    title = (
        "scatterer on the rim above the image plane, polar format: −3 dB width from the window's"
    )
    assert values[f"{title}, worst interval as wanted"].value > 20
    assert values[f"{title}, worst interval as used"].met
    (path,) = write_pictures(part.pictures, tmp_path)
    assert path.name == "cpi-timeline.png"
