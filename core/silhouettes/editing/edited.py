"""A silhouette after an edit."""

from dataclasses import replace

from core.arrays import Floats
from core.silhouettes.silhouette import Silhouette

BY_HAND = "; by hand: "
"""Stands in a provenance between where the outline came from and the tools that changed it."""


def edited(silhouette: Silhouette, rings: tuple[Floats, ...], tool: str) -> Silhouette:
    """Return the silhouette with new rings and the tool in its provenance.

    Claim, component and image stay. Each tool is named once, in the order of its last use, so
    that a thousand strokes do not make a long text; the journal has them all.

    Args:
        silhouette: as it was.
        rings: as the tool left them.
        tool: its name, for people to read.

    Raises:
        ValueError: a tool without a name, or with a comma or semicolon in it.
    """
    if not tool.strip() or set(tool) & set(",;"):
        raise ValueError(f'A tool needs a name without commas and semicolons, got "{tool}".')
    origin, _, tools = silhouette.provenance.partition(BY_HAND)
    used = [name for name in tools.split(", ") if name and name != tool]
    return replace(silhouette, rings=rings, provenance=origin + BY_HAND + ", ".join([*used, tool]))
