// Vertices: drag one, put one in at an edge's middle, take one out.

import { inserted, moved, nearestMiddle, nearestVertex, removed } from "./rings.js";

const REACH_PX = 9;

/** The tool that moves vertices; Shift pulls their neighbours within the brush's radius along. */
export function vertexTool(editor) {
  const { session, view, scene } = editor;
  let drag = null;

  const hit = (place) => nearestVertex(session.rings, editor.toCanvas, place, REACH_PX);
  const middle = (place) => nearestMiddle(session.rings, editor.toCanvas, place, REACH_PX - 1);

  return {
    name: "vertex",
    cursor: "default",
    down(event, place) {
      let vertex = hit(place);
      if (vertex && event.altKey) return remove(vertex);
      let { rings } = session;
      if (!vertex) {
        const edge = middle(place);
        if (!edge) {
          scene.selected = null;
          return false;
        }
        rings = inserted(rings, edge, edge.middle);
        vertex = { ring: edge.ring, index: edge.index + 1 };
      }
      scene.selected = vertex;
      drag = { rings, vertex, from: view.pixelAt(...place), isInserted: rings !== session.rings };
      return true;
    },
    move(event, place) {
      if (drag) {
        const to = view.pixelAt(...place);
        const by = [to[0] - drag.from[0], to[1] - drag.from[1]];
        const reach = event.shiftKey ? editor.brushRadius : 0;
        session.sketch(moved(drag.rings, drag.vertex, by, reach), "vertex");
        return;
      }
      scene.hovered = hit(place);
      editor.setCursor(scene.hovered ? "move" : middle(place) ? "copy" : "default");
    },
    up() {
      if (!drag) return;
      const { isInserted, rings } = drag;
      drag = null;
      const isDragged = session.rings !== rings;
      session.commit(isInserted && !isDragged ? rings : session.rings, "vertex");
    },
    cancel() {
      if (!drag) return false;
      drag = null;
      session.withdraw();
      session.adopt(session.frame);
      return true;
    },
    remove() {
      const vertex = scene.selected ?? scene.hovered;
      if (vertex && session.rings[vertex.ring]?.[vertex.index]) remove(vertex);
    },
  };

  function remove(vertex) {
    scene.selected = null;
    scene.hovered = null;
    session.commit(removed(session.rings, vertex), "vertex");
    return false;
  }
}
