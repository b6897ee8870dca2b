from contextlib import suppress
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.analysis.analysis import Analysis
from core.analysis.history import NothingLeft, Outlined, StaleRevision
from core.hull.drawing import drawn_silhouette
from core.hull.volume import VoteVolume
from core.reconstruction import reconstruct
from core.silhouettes.extraction import ExtractionSettings, extract_silhouette
from tests.app.synthetic import SETTINGS, empty_frame, frames

FRAMES = [*frames(5), empty_frame(time_s=30.0)]
OUTLINES = [extract_silhouette(frame) for frame in FRAMES]
COARSE = replace(SETTINGS, spacing_m=0.8)


def analysis(chosen=COARSE, count=6):
    made = Analysis(chosen)
    for frame, silhouette in zip(FRAMES[:count], OUTLINES, strict=False):
        made.receive(frame, silhouette)
    return made


def moved(silhouette, step):
    return replace(silhouette, rings=tuple(ring + step for ring in silhouette.rings))


def commit(of, number, silhouette, tool="move"):
    revision = of.frame(number).layer(silhouette.component).history.revision
    return of.commit(number, silhouette, tool=tool, base_revision=revision)


def from_scratch(of):
    """Carve the same frames, outlines, states and settings in one go."""
    fresh = Analysis(of.settings)
    for frame in of.frames:
        fresh.receive(frame.received, frame.silhouette)
        for label in frame.parts:
            commit(fresh, frame.number, frame.layer(label).silhouette)
        fresh.set_state(frame.number, frame.state)
    return fresh


def assert_same_hull(one, other):
    assert [part.label for part in one.parts] == [part.label for part in other.parts]
    pairs = [(one, other), *zip(one.parts, other.parts, strict=True)]
    for mine, theirs in pairs:
        assert np.array_equal(mine.surface.vertices_m, theirs.surface.vertices_m)
        assert np.array_equal(mine.surface.faces, theirs.surface.faces)
        assert mine.hull.voting == theirs.hull.voting
        assert mine.hull.threshold == theirs.hull.threshold
        assert mine.hull.volume_m3 == theirs.hull.volume_m3


def drag(of, number, random):
    rings = [np.array(ring) for ring in of.frame(number).silhouette.rings]
    if rings:
        rings[0][random.integers(len(rings[0]))] += random.normal(size=2) * 3
        commit(of, number, drawn_silhouette(rings, image_shape=(160, 160), claim="lit side")[0])


def take_extraction_back(of, number, random):
    with suppress(NothingLeft):
        of.undo_extraction()


def undo_or_redo(of, number, random):
    history = of.frame(number).history
    if history.can_undo and (not history.can_redo or random.random() < 0.6):
        of.undo(number, base_revision=history.revision)
    elif history.can_redo:
        of.redo(number, base_revision=history.revision)


def preview(of, number, random):
    shifted = moved(OUTLINES[1], random.normal(size=2))
    of.preview(number, shifted, base_revision=of.frame(number).history.revision)
    assert of.hull.is_preview


def shrunk(silhouette, label, share=0.5):
    """Return an outline of a part: the target's, drawn together toward its middle."""
    middle = np.concatenate(silhouette.rings).mean(axis=0)
    rings = tuple(middle + share * (ring - middle) for ring in silhouette.rings)
    return replace(silhouette, rings=rings, component=label)


def draw_part(of, number, random):
    outline = shrunk(OUTLINES[random.integers(5)], random.choice(["knife", "panel"]).item())
    commit(of, number, outline)


def undo_part(of, number, random):
    label = random.choice(["knife", "panel"]).item()
    history = of.frame(number).layer(label).history
    with suppress(NothingLeft):
        step = of.undo if random.random() < 0.6 else of.redo
        step(number, component=label, base_revision=history.revision)


def delete_part(of, number, random):
    if of.frame(number).parts:
        of.delete_part(of.frame(number).parts[0])


def preview_part(of, number, random):
    outline = shrunk(OUTLINES[1], "knife")
    before = of.hull
    of.preview(number, outline, base_revision=of.frame(number).layer("knife").history.revision)
    assert of.parts[0].hull.is_preview
    assert of.hull is before or before.is_preview


def rewind(of, number, random):
    before = [(f.silhouette, f.state) for f in of.frames]
    of.rewind()
    for frame in FRAMES[: random.integers(1, 7)]:
        of.receive(frame)
    after = [(f.silhouette, f.state) for f in of.frames]
    assert all(one == other for one, other in zip(before, after, strict=False))


def carve(**change):
    return lambda of, number, random: of.set_carving(
        replace(
            of.settings, **{key: random.choice(values).item() for key, values in change.items()}
        )
    )


def set_range(of, number, random):
    chosen = [(1, None), (2, None), (number, number), (1, 4)][random.integers(4)]
    of.set_carving(replace(of.settings, frame_range=chosen))


OPERATIONS = {
    "drag": drag,
    "move": lambda of, n, random: commit(of, n, moved(OUTLINES[0], random.normal(size=2))),
    "nothing": lambda of, n, random: commit(of, n, OUTLINES[5]),
    "undo": undo_or_redo,
    "exclude": lambda of, n, random: of.set_state(n, "excluded"),
    "include": lambda of, n, random: of.set_state(n, "ok"),
    "misses": carve(tolerated_misses=[0, 1, 2]),
    "rule": carve(rule=["shadow", "strict"]),
    "grid": carve(spacing_m=[0.8, 1.1]),
    "range": set_range,
    "preview": preview,
    "end preview": lambda of, n, random: of.end_preview(),
    "receive": lambda of, n, random: of.receive(FRAMES[len(of.frames) % 6]),
    "part": draw_part,
    "part again": draw_part,
    "part undo": undo_part,
    "part deleted": delete_part,
    "part preview": preview_part,
    "extract": lambda of, n, random: of.extract_again(ExtractionSettings(closing_px=3)),
    "extract back": take_extraction_back,
    "rewind": rewind,
}


@settings(max_examples=25, deadline=None)
@given(
    seed=st.integers(0, 2**31),
    operations=st.lists(st.sampled_from(sorted(OPERATIONS)), max_size=12),
)
def test_the_hull_equals_the_one_from_scratch_after_any_operations(seed, operations):
    random = np.random.default_rng(seed)
    of = analysis()
    for operation in operations:
        number = int(random.integers(1, len(of.frames) + 1))
        OPERATIONS[operation](of, number, random)
        of.parts  # noqa: B018 - meshed at every step, so that the next one meshes what changed
    of.end_preview()
    assert_same_hull(of, from_scratch(of))


@pytest.mark.parametrize("frame_range", [(1, None), (2, 4)])
def test_an_analysis_without_edits_is_the_reconstruction(frame_range):
    chosen = replace(SETTINGS, frame_range=frame_range)
    growing = Analysis(chosen)
    for step, frame in zip(reconstruct(FRAMES, chosen), FRAMES, strict=True):
        received = growing.receive(frame)
        hull = growing.hull
        assert np.array_equal(growing.surface.vertices_m, step.surface.vertices_m)
        assert np.array_equal(growing.surface.faces, step.surface.faces)
        assert (hull.frames, hull.voting, hull.threshold) == (
            step.number,
            step.voting,
            step.threshold,
        )
        assert [e.value_m for e in hull.extents] == [e.value_m for e in step.extents]
        assert [x.length_m for x in hull.lines] == [x.length_m for x in step.lines]
        assert received.note == step.note


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 2**31), edits=st.integers(1, 4))
def test_undoing_every_edit_is_as_if_there_had_been_none(seed, edits):
    random = np.random.default_rng(seed)
    of, untouched = analysis(count=4), analysis(count=4)
    numbers = [int(random.integers(1, 5)) for _ in range(edits)]
    for number in numbers:
        commit(of, number, moved(OUTLINES[number - 1], random.normal(size=2)))
    for number in numbers:
        of.undo(number, base_revision=of.frame(number).history.revision)
    assert_same_hull(of, untouched)
    for frame, outline in zip(of.frames, OUTLINES, strict=False):
        assert frame.silhouette is outline
    assert len(of.journal) == 2 * edits


def test_an_edit_from_an_outline_that_has_changed_is_refused():
    of = analysis(count=3)
    before = of.hull
    of.commit(2, moved(OUTLINES[1], 1.0), tool="move", base_revision=0)
    with pytest.raises(StaleRevision, match="starts from revision 0, and revision 1 is current"):
        of.commit(2, moved(OUTLINES[1], 2.0), tool="move", base_revision=0)
    assert of.hull.revision > before.revision
    assert len(of.journal) == 1


def test_undo_changes_no_other_frame_and_redo_ends_with_a_new_edit():
    of = analysis(count=3)
    commit(of, 1, moved(OUTLINES[0], 1.0))
    commit(of, 2, moved(OUTLINES[1], 1.0))
    second = of.frame(2)
    of.undo(1, base_revision=1)
    assert of.frame(2) is second
    assert of.frame(1).silhouette is OUTLINES[0]
    assert of.frame(1).history.can_redo
    commit(of, 1, moved(OUTLINES[0], 3.0))
    with pytest.raises(NothingLeft, match="no edit of this frame to do again"):
        of.redo(1, base_revision=3)
    assert [edit.tool for edit in of.journal] == ["move", "move", "undo", "move"]
    assert [edit.revision for edit in of.journal] == [1, 1, 2, 3]


def test_extracting_again_keeps_edited_outlines_unless_asked():
    of = analysis(count=3)
    edited = commit(of, 2, moved(OUTLINES[1], 1.0)).silhouette
    changed = of.extract_again(ExtractionSettings(closing_px=9))
    assert [frame.number for frame in changed] == [1, 3]
    assert of.frame(2).silhouette is edited
    of.extract_again(ExtractionSettings(closing_px=9), overwrites_edited=True)
    assert not of.frame(2).history.is_edited
    assert of.undo(2, base_revision=2).silhouette is edited
    assert of.frame(2).history.is_edited


def test_an_extraction_leaves_alone_what_it_finds_again_and_can_be_taken_back():
    of = analysis(count=3)
    assert of.extract_again(ExtractionSettings()) == ()
    edited = commit(of, 2, replace(OUTLINES[1])).silhouette
    changed = of.extract_again(ExtractionSettings(closing_px=9), overwrites_edited=True)
    assert [frame.number for frame in changed] == [1, 2, 3]
    later = commit(of, 3, moved(OUTLINES[2], 1.0)).silhouette
    assert [frame.number for frame in of.undo_extraction()] == [1, 2]
    assert of.frame(1).silhouette is OUTLINES[0]
    assert of.frame(2).silhouette is edited
    assert of.frame(3).silhouette is later
    assert of.settings.extraction == ExtractionSettings()
    assert_same_hull(of, from_scratch(of))
    of.undo_extraction()
    with pytest.raises(NothingLeft, match="no detection in all frames"):
        of.undo_extraction()


def test_an_excluded_frame_does_not_vote_and_says_so():
    of = analysis(count=3)
    excluded = of.set_state(2, "excluded")
    assert not excluded.votes
    assert excluded.note == "frame 2 is excluded and does not vote"
    assert (of.hull.voting, of.hull.threshold) == (2, 2)
    assert of.set_state(2, "fix").votes
    with pytest.raises(ValueError, match='todo, ok, fix, excluded; it cannot be "done"'):
        of.set_state(2, "done")


def test_frames_outside_the_range_keep_their_place_and_do_not_vote():
    of = analysis()
    whole = of.hull
    of.set_carving(replace(COARSE, frame_range=(2, 4)))
    assert [frame.votes for frame in of.frames] == [False, True, True, True, False, False]
    assert of.frame(1).note == (
        "frame 1 lies outside the range of frames that vote and does not vote"
    )
    assert of.frame(6).note == "frame 6 shows no target and does not vote"
    assert (of.hull.voting, of.hull.threshold) == (3, 3)
    assert of.hull.volume_m3 > whole.volume_m3
    of.set_carving(COARSE)
    assert of.hull.volume_m3 == whole.volume_m3
    with pytest.raises(ValueError, match="a last one that is not before it; got 3 to 2"):
        replace(COARSE, frame_range=(3, 2))


def test_a_review_state_that_changes_no_vote_leaves_the_hull_as_it_is():
    of = analysis(count=3)
    before = of.hull
    assert of.set_state(2, "ok").state == of.frame(2).state == "ok"
    assert of.hull is before
    of.preview(2, moved(OUTLINES[1], 5.0), base_revision=0)
    of.set_state(2, "fix")
    assert not of.hull.is_preview
    assert of.set_state(2, "excluded").votes is False
    assert of.hull.revision > before.revision


def test_an_outline_that_cannot_vote_changes_nothing():
    of = analysis(count=3)
    before = of.hull
    line = np.array([[0.0, 0], [5, 5], [9, 9]])
    flat = replace(OUTLINES[0], rings=(line,), claim="complete")
    with pytest.raises(ValueError, match="encloses no area"):
        commit(of, 1, flat)
    assert of.hull is before
    assert of.frame(1).history.revision == 0
    assert of.journal == ()


def test_a_preview_is_coarser_says_so_and_leaves_the_votes_alone():
    of = analysis(replace(SETTINGS, spacing_m=0.2), count=4)
    whole, votes = of.hull, of.volume.votes.copy()
    of.preview(2, moved(OUTLINES[1], 5.0), base_revision=0)
    assert of.hull.is_preview
    assert of.hull.face_count < 0.8 * whole.face_count
    assert of.hull.volume_m3 != pytest.approx(whole.volume_m3, rel=1e-3)
    assert np.array_equal(of.volume.votes, votes)
    assert of.hull.revision > whole.revision == of.revision
    of.end_preview()
    assert of.hull is whole
    of.preview(2, moved(OUTLINES[1], 3.0), base_revision=0)
    commit(of, 2, moved(OUTLINES[1], 3.0))
    assert of.hull.revision == of.revision == whole.revision + 1


def test_the_frame_that_empties_the_hull_is_named():
    of = analysis(count=4)
    assert of.hull.emptied_by == ()
    commit(of, 3, moved(OUTLINES[2], 70.0))
    assert of.hull.face_count == 0
    assert 3 in of.hull.emptied_by
    for number in of.hull.emptied_by:
        of.set_state(number, "excluded")
    assert of.hull.face_count > 0


def test_a_grid_too_large_is_refused_and_changes_nothing():
    of = analysis(count=2)
    before = of.hull
    with pytest.raises(ValueError, match="Use a larger spacing"):
        of.set_carving(replace(of.settings, spacing_m=1e-3))
    assert of.hull is before
    assert of.settings == COARSE


def test_frames_that_never_came_are_not_there():
    with pytest.raises(ValueError, match="There is no frame 7; 6 have arrived so far"):
        analysis().undo(7, base_revision=0)


def test_the_volume_holds_one_view_per_frame_in_order():
    of = analysis()
    assert isinstance(of.volume, VoteVolume)
    assert list(of.volume.voters) == [0, 1, 2, 3, 4, 5]
    assert [voter.votes for voter in of.volume.voters.values()] == [True] * 5 + [False]


def test_several_outlines_are_taken_over_together_or_not_at_all():
    work = analysis(count=3)
    before = work.revision
    square = drawn_silhouette(
        [[[60, 60], [60, 100], [100, 100], [100, 60]]], image_shape=(160, 160), claim="lit side"
    )[0]
    outlined = Outlined(silhouette=square, tool="import")
    with pytest.raises(ValueError, match="There is no frame 9"):
        work.commit_all([(1, outlined), (9, outlined)], tool="import")
    assert work.revision == before
    assert not work.frame(1).history.is_edited
    work.commit_all([(1, outlined), (3, outlined)], tool="import")
    assert [frame.history.is_edited for frame in work.frames] == [True, False, True]
    assert_same_hull(work, from_scratch(work))
    assert [edit.tool for edit in work.journal] == ["import", "import"]


def test_revisions_go_on_from_those_of_an_earlier_analysis():
    later = Analysis(COARSE, revision=40)
    later.receive(FRAMES[0], OUTLINES[0])
    assert later.frame(1).history.revision == 40
    assert later.hull.revision == 41
    with pytest.raises(StaleRevision):
        later.commit(1, OUTLINES[0], tool="move", base_revision=0)
