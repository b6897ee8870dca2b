from itertools import pairwise

import pytest

from app.layers import COMPONENT_COLOURS, component_colours, css, known_layers


def test_the_whole_target_keeps_its_colour_and_each_component_has_its_own() -> None:
    assert component_colours([]) == {"target": COMPONENT_COLOURS[0]}
    colours = component_colours(["panel", "boom", "target", "panel"])
    assert list(colours) == ["target", "panel", "boom"]
    assert component_colours(["panel", "boom", "antenna"]) == {
        **colours,
        "antenna": COMPONENT_COLOURS[3],
    }
    assert colours["target"] == COMPONENT_COLOURS[0]
    assert len(set(colours.values())) == 3


def test_more_components_than_colours_recur_but_never_beside_each_other() -> None:
    colours = list(component_colours(map(str, range(20))).values())
    assert all(one != other for one, other in pairwise(colours))


def test_a_colour_is_written_as_style_sheets_have_it() -> None:
    assert css((168, 0, 204)) == "#a800cc"


def test_an_unknown_layer_is_named() -> None:
    assert known_layers(["hull", "hull"]) == {"hull"}
    with pytest.raises(ValueError, match="no layer clouds; the layers are distance, grid, hull"):
        known_layers(["hull", "clouds"])
