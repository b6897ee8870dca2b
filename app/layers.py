"""The viewport's layers and their colours: one table for the scene and for the page's legend."""

from collections.abc import Iterable
from dataclasses import dataclass

from core.silhouettes.silhouette import WHOLE

Colour = tuple[int, int, int]

COMPONENT_COLOURS: tuple[Colour, ...] = (
    (168, 184, 204),
    (230, 159, 0),
    (86, 180, 233),
    (0, 158, 115),
    (240, 228, 66),
    (213, 94, 0),
    (204, 121, 167),
    (0, 114, 178),
)
"""The whole target's, then those of its components.

Source: Okabe and Ito, "Color universal design", 2008: told apart by colour-blind eyes too.
"""

OUTLINE_COLOUR: Colour = (64, 224, 208)
SIGHT_COLOUR: Colour = (240, 140, 20)
PLANE_COLOUR: Colour = (96, 110, 135)
WIREFRAME_COLOUR: Colour = (46, 110, 190)
GRID_COLOUR: Colour = (64, 76, 98)
UNCARVED_COLOUR: Colour = (86, 180, 233)
REFERENCE_COLOUR: Colour = (204, 121, 167)
KEY_POINT_COLOUR: Colour = (255, 176, 72)
LENGTH_COLOUR: Colour = (240, 228, 66)
ATTITUDE_COLOUR: Colour = (230, 130, 190)
SECTION_COLOUR: Colour = (120, 205, 255)
STALE_COLOUR: Colour = (140, 148, 160)
PICK_COLOUR: Colour = (255, 255, 255)
OUTSIDE_COLOUR: Colour = (178, 24, 43)


@dataclass(frozen=True, slots=True, kw_only=True)
class Layer:
    """A part of the scene that each page shows or hides.

    Attributes:
        name: of its node in the scene and in links.
        title: on its button.
        hint: what it shows.
        colour: that it has in the scene.
        is_on: whether a page begins with it.
    """

    name: str
    title: str
    hint: str
    colour: Colour
    is_on: bool = True

    @property
    def node(self) -> str:
        """The scene's node above all that belongs to it."""
        return f"/{self.name}"


REFERENCE_LAYERS = frozenset({"reference", "distance"})
"""That there are only with a reference."""

LAYERS = (
    Layer(
        name="hull",
        title="Hull",
        hint="The target's hull; translucent while parts have hulls of their own, which show in it",
        colour=COMPONENT_COLOURS[0],
    ),
    Layer(
        name="wireframe",
        title="Wireframe",
        hint="The edges of the hull's triangles",
        colour=WIREFRAME_COLOUR,
        is_on=False,
    ),
    Layer(
        name="picture",
        title="Frame",
        hint="The frame on show, in its imaging plane beside the hull",
        colour=PLANE_COLOUR,
    ),
    Layer(
        name="outline",
        title="Outline",
        hint="Its silhouette, on the picture",
        colour=OUTLINE_COLOUR,
    ),
    Layer(
        name="key-points",
        title="Key points",
        hint="Corners marked in two or more frames, where their marks place them",
        colour=KEY_POINT_COLOUR,
    ),
    Layer(
        name="sights",
        title="Lines of sight",
        hint="This frame's line of sight as an arrow, those of all frames as dots",
        colour=SIGHT_COLOUR,
    ),
    Layer(
        name="grid",
        title="Grid, axes",
        hint="Axes of the target frame: x along-track, y cross-track (against the orbit normal), "
        "z nadir, shown down; below the target a grid of 1 m and 5 m",
        colour=GRID_COLOUR,
    ),
    Layer(
        name="uncarved",
        title="Uncarved",
        hint="Beyond the hull, what only few views have carved away: it would belong to the hull "
        "if one view in ten, at least one, missed what it should have shown. It follows the kept "
        "outlines, on a coarser grid",
        colour=UNCARVED_COLOUR,
        is_on=False,
    ),
    Layer(
        name="measurements",
        title="Measurements",
        hint="Lengths, attitudes and sections that are not hidden; grey while they belong to an "
        "earlier hull. A line that would run inside the hull is drawn beside it",
        colour=LENGTH_COLOUR,
    ),
    Layer(
        name="reference",
        title="Reference",
        hint="The mesh given with --reference, in its attitude",
        colour=REFERENCE_COLOUR,
        is_on=False,
    ),
    Layer(
        name="distance",
        title="Distance",
        hint="The hull, coloured by its signed distance from the reference: blue inside it, red "
        "outside. It belongs to the hull that was last compared",
        colour=OUTSIDE_COLOUR,
        is_on=False,
    ),
)
"""In the order of their buttons."""

FIRST_LAYERS = frozenset(layer.name for layer in LAYERS if layer.is_on)


def known_layers(names: Iterable[str]) -> frozenset[str]:
    """Return the names as a set.

    Raises:
        ValueError: a name that no layer has.
    """
    wanted, known = set(names), {layer.name for layer in LAYERS}
    if unknown := sorted(wanted - known):
        raise ValueError(
            f"There is no layer {', '.join(unknown)}; the layers are {', '.join(sorted(known))}."
        )
    return frozenset(wanted)


def component_colours(labels: Iterable[str]) -> dict[str, Colour]:
    """Return a colour for each component, the whole target first; beyond eight they recur.

    A label that comes behind others changes none of their colours.
    """
    return {
        label: COMPONENT_COLOURS[place % len(COMPONENT_COLOURS)]
        for place, label in enumerate(dict.fromkeys((WHOLE, *labels)))
    }


def css(colour: Colour) -> str:
    """Return a colour as style sheets write it."""
    return "#" + "".join(f"{part:02x}" for part in colour)
