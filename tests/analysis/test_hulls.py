"""Parts of a target have hulls of their own, which nothing else changes."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.analysis.analysis import Analysis
from core.analysis.history import NothingLeft, Outlined, StaleRevision
from core.analysis.hulls import MOST_PARTS
from core.hull.volume import VoteVolume
from core.reconstruction import ballot_of
from tests.analysis.test_analysis import (
    COARSE,
    FRAMES,
    OPERATIONS,
    OUTLINES,
    analysis,
    assert_same_hull,
    commit,
    from_scratch,
    moved,
    shrunk,
)


def with_parts(count=5):
    of = analysis(count=count)
    for number in range(1, 4):
        commit(of, number, shrunk(OUTLINES[number - 1], "knife"))
        commit(of, number + 1, shrunk(OUTLINES[number], "panel", 0.7))
    return of


def hulls(of):
    return {"target": of.hull, **{part.label: part.hull for part in of.parts}}


def test_a_part_is_carved_from_the_frames_that_outline_it_and_by_them_alone():
    of = with_parts()
    knife, panel = of.parts
    assert (knife.label, panel.label) == ("knife", "panel")
    assert [frame.parts for frame in of.frames] == [
        ("knife",),
        ("knife", "panel"),
        ("knife", "panel"),
        ("panel",),
        (),
    ]
    volume = VoteVolume(COARSE.grid())
    for number in range(3):
        outline = shrunk(OUTLINES[number], "knife")
        volume.add(ballot_of(FRAMES[number], outline, COARSE).view)
    assert np.array_equal(knife.surface.vertices_m, volume.surface().vertices_m)
    assert (knife.hull.voting, knife.hull.threshold) == (3, 3)
    assert of.hull.voting == 5


@settings(max_examples=5, deadline=None)
@given(
    seed=st.integers(0, 2**31),
    operations=st.lists(st.sampled_from(["part", "part undo", "part deleted", "preview",
        "part preview", "move", "drag", "undo", "end preview"]), min_size=1, max_size=8),
)  # fmt: skip
def test_editing_one_component_never_changes_another_s_hull(seed, operations):
    random = np.random.default_rng(seed)
    of = with_parts()
    for operation in operations:
        of.end_preview()
        before = hulls(of)
        journal = len(of.journal)
        OPERATIONS[operation](of, int(random.integers(1, 6)), random)
        touched = {edit.component for edit in of.journal[journal:]}
        for label, hull in hulls(of).items():
            if label in before and label not in touched and not hull.is_preview:
                assert hull is before[label]


@settings(max_examples=5, deadline=None)
@given(
    seed=st.integers(0, 2**31),
    operations=st.lists(st.sampled_from(sorted(OPERATIONS)), max_size=10),
)
def test_a_revision_names_one_hull_of_one_component_only(seed, operations):
    random = np.random.default_rng(seed)
    of = with_parts()
    named = {}
    for operation in operations:
        OPERATIONS[operation](of, int(random.integers(1, len(of.frames) + 1)), random)
        kept = {label: hull for label, hull in hulls(of).items() if not hull.is_preview}
        for label, hull in kept.items():
            numbers = (label, hull.voting, hull.vertex_count, hull.volume_m3)
            assert named.setdefault(hull.revision, {}).setdefault(label, numbers) == numbers
            assert hull.revision <= of.revision


def test_each_layer_has_an_undo_of_its_own():
    of = with_parts()
    whole, panel = of.hull, of.parts[1].hull
    commit(of, 2, moved(shrunk(OUTLINES[1], "knife"), 2.0))
    with pytest.raises(StaleRevision):
        of.undo(2, component="knife", base_revision=1)
    of.undo(2, component="knife", base_revision=2)
    assert_same_hull(of, with_parts())
    assert of.hull is whole
    assert of.parts[1].hull is panel
    with pytest.raises(NothingLeft):
        of.undo(2, base_revision=0)
    assert (of.journal[-1].component, of.journal[-1].tool) == ("knife", "undo")


def test_a_part_s_first_outline_is_taken_back_with_its_hull():
    of = analysis(count=3)
    commit(of, 2, shrunk(OUTLINES[1], "knife"))
    assert [part.hull.voting for part in of.parts] == [1]
    of.undo(2, component="knife", base_revision=1)
    assert of.parts == ()
    of.redo(2, component="knife", base_revision=2)
    assert [part.label for part in of.parts] == ["knife"]


def test_deleting_a_part_takes_it_out_of_all_frames_and_can_be_undone_in_each():
    of = with_parts()
    knife, whole = of.parts[0], of.hull
    assert [frame.number for frame in of.delete_part("knife")] == [1, 2, 3]
    assert [part.label for part in of.parts] == ["panel"]
    assert of.hull is whole
    for number in (1, 2, 3):
        of.undo(number, component="knife", base_revision=2)
    assert np.array_equal(of.parts[0].surface.vertices_m, knife.surface.vertices_m)
    assert of.parts[0].hull.revision > knife.hull.revision
    for label in ("boom", "target"):
        with pytest.raises(ValueError, match=f'outline of a part called "{label}"'):
            of.delete_part(label)


def test_excluded_frames_range_and_carving_hold_for_parts_too():
    of = with_parts()
    of.set_state(2, "excluded")
    assert [part.hull.voting for part in of.parts] == [2, 2]
    of.set_carving(replace(COARSE, frame_range=(3, None), spacing_m=1.1, rule="strict"))
    assert [part.hull.voting for part in of.parts] == [1, 2]
    assert_same_hull(of, from_scratch(of))


def test_a_part_has_a_place_only_where_views_bound_it_and_the_whole_and_both_are_kept():
    of = analysis(count=5)
    for number in range(1, 6):
        whole = replace(OUTLINES[number - 1], claim="complete")
        commit(of, number, whole)
        commit(of, number, shrunk(whole, "knife"))
    assert of.parts[0].has_place_in(of.hull)
    of.preview(1, shrunk(OUTLINES[0], "knife"), base_revision=1)
    assert not of.parts[0].has_place_in(of.hull)
    for number in (2, 3, 4, 5):
        of.set_state(number, "excluded")
    assert of.parts[0].hull.voting == 1
    assert not of.parts[0].has_place_in(of.hull)


def test_an_outline_that_cannot_vote_and_a_part_too_many_change_nothing():
    of = with_parts()
    before = hulls(of)
    line = np.array([[0.0, 0], [5, 5], [9, 9]])
    flat = replace(OUTLINES[0], rings=(line,), claim="complete", component="knife")
    with pytest.raises(ValueError, match="encloses no area"):
        commit(of, 1, flat)
    for number in range(MOST_PARTS - 2):
        commit(of, 1, shrunk(OUTLINES[0], f"part {number}"))
    with pytest.raises(ValueError, match="at most 12 parts"):
        commit(of, 1, shrunk(OUTLINES[0], "one more"))
    after = hulls(of)
    assert all(after[label] is hull for label, hull in before.items())
    assert_same_hull(of, from_scratch(of))


def test_votes_are_as_they_were_after_outlines_of_which_one_cannot_vote():
    of = with_parts()
    votes = of.volume.votes.copy()
    line = np.array([[0.0, 0], [5, 5], [9, 9]])
    flat = replace(OUTLINES[1], rings=(line,), claim="complete")
    outlines = [
        (1, Outlined(silhouette=moved(OUTLINES[0], 9.0), tool="import")),
        (2, Outlined(silhouette=flat, tool="import")),
    ]
    with pytest.raises(ValueError, match="encloses no area"):
        of.commit_all(outlines, tool="import")
    assert np.array_equal(of.volume.votes, votes)
    assert_same_hull(of, with_parts())


def test_registration_by_the_whole_target_moves_its_parts_along():
    chosen = replace(COARSE, registration="centroid")
    of = Analysis(chosen)
    for frame, silhouette in zip(FRAMES[:3], OUTLINES, strict=False):
        of.receive(frame, silhouette)
    commit(of, 1, shrunk(OUTLINES[0], "knife"))
    placed = of.frame(1).layer("knife").ballot.view.projection
    assert placed is of.frame(1).ballot.view.projection
    commit(of, 1, moved(OUTLINES[0], 3.0))
    again = of.frame(1).layer("knife").ballot.view.projection
    np.testing.assert_allclose(again.matrix[:, 3], placed.matrix[:, 3] + 3.0)
    assert_same_hull(of, from_scratch(of))
    commit(of, 1, replace(OUTLINES[0], rings=()))
    assert [part.hull.voting for part in of.parts] == [0]
