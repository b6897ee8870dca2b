from core.experiments.physics.near_field import near_field_part
from core.experiments.pictures import write_pictures


def test_points_land_where_they_are_and_as_sharp_as_theory_has_it(tmp_path):
    told = []
    part = near_field_part(lambda *step: told.append(step))
    assert [figure.name for figure in part.figures if figure.met is False] == []
    assert sum(figure.met is True for figure in part.figures) == 6
    assert told[-1] == ("near field", 2, 2)
    (path,) = write_pictures(part.pictures, tmp_path)
    assert path.stat().st_size > 10_000
