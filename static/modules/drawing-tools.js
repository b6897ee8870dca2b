// Regions: polygon, lasso, brush, eraser, and a line along the edge.

import { between, brushed, combined, thinned } from "./rings.js";
import { propose } from "./server.js";

const CLOSE_PX = 9;

/** Points one after the other; Enter, a double click or the first point again closes the ring. */
export function polygonTool(editor) {
  const { view, scene } = editor;
  return {
    name: "polygon",
    cursor: "crosshair",
    down(event, place) {
      const point = view.pixelAt(...place);
      if (!scene.draft) start(editor, [point], true);
      else if (isClosing(editor, scene.draft.points, place)) finish(editor, "polygon");
      else scene.draft.points.push(point);
      return false;
    },
    move() {},
    up() {},
    double: () => finish(editor, "polygon"),
    accept: () => finish(editor, "polygon"),
    back() {
      scene.draft?.points.pop();
      if (scene.draft?.points.length === 0) scene.draft = null;
    },
    cancel: () => cancelDraft(editor),
  };
}

/** One stroke around a region. */
export function lassoTool(editor) {
  const { view, scene } = editor;
  return {
    name: "lasso",
    cursor: "crosshair",
    down(event, place) {
      start(editor, [view.pixelAt(...place)], false);
      return true;
    },
    move(event, place) {
      scene.draft?.points.push(view.pixelAt(...place));
    },
    up() {
      if (scene.draft) scene.draft.points = thinned(scene.draft.points, 0.4);
      finish(editor, "lasso");
    },
    cancel: () => cancelDraft(editor),
  };
}

/** Points along an edge, between which the server finds the way. */
export function livewireTool(editor) {
  const { view, scene, session } = editor;
  let asked = 0;
  return {
    name: "livewire",
    cursor: "crosshair",
    async down(event, place) {
      const point = view.pixelAt(...place);
      if (!scene.draft) {
        start(editor, [point], true);
        scene.draft.marks = [point];
        return;
      }
      const { draft } = scene;
      const isLast = isClosing(editor, draft.marks, place);
      draft.marks.push(isLast ? draft.marks[0] : point);
      await follow(draft);
      if (isLast && scene.draft === draft) finish(editor, "livewire");
    },
    move() {},
    up() {},
    double: () => finish(editor, "livewire"),
    accept: () => finish(editor, "livewire"),
    back() {
      if (!scene.draft) return;
      scene.draft.marks.pop();
      if (scene.draft.marks.length === 0) scene.draft = null;
      else follow(scene.draft);
    },
    cancel: () => cancelDraft(editor),
  };

  async function follow(draft) {
    asked += 1;
    const own = asked;
    draft.points = [...draft.marks];
    if (draft.marks.length < 2) return editor.redraw();
    try {
      const parameters = { points: draft.marks };
      const { frame, component, rings } = session;
      const { path } = await propose(frame.number, component, "livewire", parameters, rings);
      if (own === asked) draft.points = path;
    } catch (error) {
      editor.complain(error.message);
    }
    editor.redraw();
  }
}

/** Paint with a disc, or rub out; what the stroke does not touch stays to the last digit. */
export function brushTool(editor, isAdding) {
  const { view, scene, session } = editor;
  return {
    name: isAdding ? "brush" : "eraser",
    cursor: "none",
    down(event, place) {
      scene.brush = { points: [view.pixelAt(...place)], centre: null, radius: 0, isAdding };
      this.move(event, place);
      return true;
    },
    move(event, place) {
      const centre = view.pixelAt(...place);
      const points = scene.brush?.points ?? [];
      if (points.length > 0 && between(points.at(-1), centre) > editor.brushRadius / 8) {
        points.push(centre);
        const { rings } = session;
        session.previewOf(() => brushed(rings, points, editor.brushRadius, isAdding), this.name);
      }
      scene.brush = { points, centre, radius: editor.brushRadius, isAdding };
    },
    up() {
      const points = scene.brush?.points ?? [];
      if (points.length === 0) return;
      scene.brush.points = [];
      const { rings } = session;
      keep(editor, () => brushed(rings, points, editor.brushRadius, isAdding), this.name);
    },
    cancel() {
      const isPainting = (scene.brush?.points.length ?? 0) > 0;
      if (isPainting) {
        scene.brush.points = [];
        session.withdraw();
      }
      return isPainting;
    },
    leave() {
      if (scene.brush) scene.brush.centre = null;
    },
  };
}

function start(editor, points, followsCursor) {
  editor.scene.draft = { points, followsCursor, isCut: editor.combining === "cut" };
}

function isClosing(editor, points, place) {
  return points.length > 2 && between(editor.toCanvas(...points[0]), place) < CLOSE_PX;
}

/** Put the drafted ring to the outline; too short a draft is forgotten. */
function finish(editor, tool) {
  const { scene, session } = editor;
  if (!scene.draft) return false;
  // The second press of a double click set the last point twice.
  const points = thinned(scene.draft.points, 1e-3);
  scene.draft = null;
  if (points.length > 2) {
    keep(editor, () => combined(session.rings, points, editor.combining), tool);
  }
  editor.redraw();
  return true;
}

/** Commit the rings that `make` gives, or say that it found none. */
function keep(editor, make, tool) {
  try {
    editor.session.commit(make(), tool);
  } catch {
    // The library gives up on some outlines that touch themselves.
    editor.complain("This stroke and the outline could not be joined; draw it a little differently.");
  }
}

function cancelDraft(editor) {
  const hadDraft = Boolean(editor.scene.draft);
  editor.scene.draft = null;
  editor.redraw();
  return hadDraft;
}
