"""The outlines of one frame, by the component that each shows: the whole target and its parts."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from core.analysis.history import EXTRACTION, History, Outlined
from core.frame import Frame
from core.hull.outline import outline_of
from core.reconstruction import Ballot, ReconstructionSettings, ballot_of
from core.silhouettes.silhouette import WHOLE, Silhouette

UNPLACED = "is registered by its outline of the target, which does not vote, and shows a part that"
"""Why a part does not vote in a frame that nothing has registered."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class OutlineLayer:
    """The outline of one component in a frame.

    Attributes:
        history: of the outline.
        ballot: how the frame votes by the present one.
    """

    history: History
    ballot: Ballot

    @property
    def silhouette(self) -> Silhouette:
        """The present outline."""
        return self.history.present.silhouette

    @property
    def vote_repair(self) -> str:
        """What had to be repaired in the outline for it to vote, empty when nothing was."""
        return "" if self.ballot.view is None else outline_of(self.ballot.view.silhouette).repair


Layers = Mapping[str, OutlineLayer]
"""By component; the whole target is always among them."""


def layers_of(
    received: Frame,
    histories: Mapping[str, History],
    settings: ReconstructionSettings,
    *,
    known: Layers | None = None,
) -> dict[str, OutlineLayer]:
    """Return how a frame votes by the outlines of its components.

    The outline of the whole target registers the frame for its parts, if the settings ask for it.

    Args:
        received: the frame as it came.
        histories: of the outlines, the whole target's among them.
        settings: by which they vote.
        known: layers that vote by these settings; those of the same histories are kept.

    Raises:
        ValueError: an outline that cannot vote.
    """
    known = known or {}
    whole = known.get(WHOLE)
    if whole is None or whole.history is not histories[WHOLE]:
        silhouette = histories[WHOLE].present.silhouette
        ballot = ballot_of(received, silhouette, settings)
        whole = OutlineLayer(history=histories[WHOLE], ballot=ballot)
    is_moved = WHOLE in known and known[WHOLE].ballot.frame is not whole.ballot.frame
    layers = {WHOLE: whole}
    for component, history in histories.items():
        before = known.get(component)
        if component == WHOLE:
            continue
        if before is not None and before.history is history and not is_moved:
            layers[component] = before
        else:
            ballot = _ballot_of_part(whole.ballot, history.present.silhouette, settings)
            layers[component] = OutlineLayer(history=history, ballot=ballot)
    return layers


def undrawn(component: str, whole: OutlineLayer, first_revision: int) -> OutlineLayer:
    """Return the layer of a component that nobody has drawn in a frame yet."""
    empty = replace(whole.silhouette, rings=(), component=component, provenance="")
    first = Outlined(silhouette=empty, tool=EXTRACTION)
    return OutlineLayer(
        history=History(outlines=(first,), revision=first_revision),
        ballot=_without(whole.ballot, f"shows no {component}"),
    )


def _ballot_of_part(
    whole: Ballot, silhouette: Silhouette, settings: ReconstructionSettings
) -> Ballot:
    if silhouette.is_empty:
        return _without(whole, f"shows no {silhouette.component}")
    if settings.registration == "centroid" and whole.view is None:
        return _without(whole, UNPLACED)
    return ballot_of(whole.frame, silhouette, replace(settings, registration="none"))


def _without(whole: Ballot, unfit: str) -> Ballot:
    return Ballot(frame=whole.frame, view=None, unfit=unfit)
