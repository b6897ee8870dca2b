import io
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
import trimesh

from app.layers import COMPONENT_COLOURS
from app.reference import compared
from app.reference_glb import coloured_glb
from app.snapshot import Record, Snapshot
from app.viewport import Viewport
from app.viser_server import PrivateViserServer
from core.analysis.analysis import Analysis
from tests.app.synthetic import SETTINGS, frames
from tests.measurement.bodies import box, surface_of


@pytest.fixture
def viewport() -> Iterator[Viewport]:
    server = PrivateViserServer()
    yield Viewport(server)
    server.stop()


def snapshot_of(analysis: Analysis) -> Snapshot:
    records = tuple(Record(analysed=frame, hull=analysis.hull) for frame in analysis.frames)
    return Snapshot(
        run=1,
        status="playing",
        speed_hz=None,
        settings=analysis.settings,
        records=records,
        hull=analysis.hull,
        surface=analysis.surface,
        parts=analysis.parts,
        outlined=analysis.components,
    )


def test_an_edit_moves_the_mesh_and_sends_no_picture_again(viewport) -> None:
    analysis = Analysis(SETTINGS)
    for frame in frames(3):
        analysis.receive(frame)
    viewport.show(snapshot_of(analysis))
    mesh, image = viewport._hull.mesh, viewport._picture.image
    before = mesh.vertices.copy()
    outline = analysis.frame(1).silhouette
    smaller = replace(outline, rings=tuple(0.9 * ring + 8 for ring in outline.rings))
    analysis.commit(1, smaller, tool="scale", base_revision=0)
    viewport.show(snapshot_of(analysis))
    assert viewport._hull.mesh is mesh
    assert mesh.vertices.shape != before.shape
    np.testing.assert_array_equal(mesh.vertices, analysis.surface.vertices_m.astype(np.float32))
    np.testing.assert_array_equal(mesh.faces, analysis.surface.faces)
    assert viewport._picture.image is image


def test_an_empty_hull_is_hidden_and_comes_back(viewport) -> None:
    analysis = Analysis(SETTINGS)
    for frame in frames(2):
        analysis.receive(frame)
    viewport.show(snapshot_of(analysis))
    analysis.set_state(1, "excluded")
    analysis.set_state(2, "excluded")
    viewport.show(snapshot_of(analysis))
    assert not viewport._hull.mesh.visible
    analysis.set_state(1, "ok")
    viewport.show(snapshot_of(analysis))
    assert viewport._hull.mesh.visible
    np.testing.assert_array_equal(viewport._hull.mesh.faces, analysis.surface.faces)


def analysis_of(count: int) -> Analysis:
    analysis = Analysis(SETTINGS)
    for frame in frames(count):
        analysis.receive(frame)
    return analysis


def test_a_wireframe_is_sent_only_while_somebody_wants_it_and_follows_the_hull(viewport) -> None:
    analysis = analysis_of(3)
    viewport.show(snapshot_of(analysis))
    assert viewport._wireframe.mesh is None
    viewport.want(frozenset({"hull", "wireframe"}))
    np.testing.assert_array_equal(viewport._wireframe.mesh.faces, analysis.surface.faces)
    analysis.set_state(1, "excluded")
    viewport.show(snapshot_of(analysis))
    np.testing.assert_array_equal(viewport._wireframe.mesh.faces, analysis.surface.faces)
    viewport.want(frozenset({"hull"}))
    assert not viewport._wireframe.mesh.visible


def test_uncarved_space_that_nobody_wants_any_more_is_not_shown(viewport) -> None:
    surface = analysis_of(2).surface
    viewport.show_uncarved(surface)
    assert viewport._uncarved.mesh is None
    viewport.want(frozenset({"uncarved"}))
    viewport.show_uncarved(surface)
    assert viewport._uncarved.mesh.visible
    viewport.want(frozenset())
    assert not viewport._uncarved.mesh.visible


def test_parts_show_in_their_colours_within_a_hull_that_lets_them_through(viewport) -> None:
    analysis = analysis_of(2)
    viewport.show(snapshot_of(analysis))
    assert viewport._hull.mesh.opacity is None
    whole = analysis.frame(1).silhouette
    for label in ("panel", "boom"):
        analysis.commit(1, replace(whole, component=label), tool="lasso", base_revision=0)
    viewport.show(snapshot_of(analysis))
    nodes = viewport._parts._nodes
    assert viewport._hull.mesh.color == COMPONENT_COLOURS[0]
    assert viewport._hull.mesh.opacity < 1
    assert nodes["panel"].mesh.color == COMPONENT_COLOURS[1]
    assert nodes["boom"].mesh.color == COMPONENT_COLOURS[2]
    assert len(nodes["panel"].mesh.vertices) == len(analysis.parts[1].surface.vertices_m)
    analysis.delete_part("panel")
    viewport.show(snapshot_of(analysis))
    assert not nodes["panel"].mesh.visible
    assert nodes["boom"].mesh.color == COMPONENT_COLOURS[2]
    analysis.delete_part("boom")
    viewport.show(snapshot_of(analysis))
    assert viewport._hull.mesh.opacity is None


def test_a_reference_stands_where_its_mesh_does() -> None:
    server = PrivateViserServer()
    body = trimesh.creation.box((3.0, 2.0, 1.0))
    Viewport(server, reference=surface_of(body))
    (mesh,) = [
        m
        for m in server._websock_server._broadcast_buffer.message_from_id.values()
        if getattr(m, "name", "") == "/reference/mesh" and hasattr(m, "props")
    ]
    np.testing.assert_array_equal(mesh.props.vertices, body.vertices.astype(np.float32))
    assert mesh.props.opacity < 1
    server.stop()


def test_a_compared_hull_is_shown_in_its_colours_until_it_is_taken_off(viewport) -> None:
    hull = box((4.0, 2.0, 1.0), fineness=2)
    done = compared(hull, box((3.8, 2.0, 1.0)), revision=1, spacing_m=0.1)
    viewport.show_distances(done)
    scene = viewport._server.scene
    assert scene.get_handle_by_name("/distance/surface") is not None
    (mesh,) = trimesh.load(io.BytesIO(coloured_glb(done)), file_type="glb").geometry.values()
    outside = mesh.vertices[:, 0] > 2.0
    # #b2182b, in proportion to light.
    red = mesh.visual.vertex_attributes["color"][:, :3] == [114, 2, 6]
    assert np.all(red[outside])
    assert mesh.visual.material.metallicFactor == 0
    viewport.show_distances(None)
    assert scene.get_handle_by_name("/distance/surface") is None
