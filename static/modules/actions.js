// What each key of the table does, on the parts of the page.

import { all } from "./elements.js";
import { bindShortcuts } from "./shortcuts.js";

const DRAWING = ["vertex", "polygon", "lasso", "brush", "eraser", "livewire", "keypoint"];
const PROPOSING = ["threshold", "grow", "snap", "copy previous", "copy next", "reprojection"];
const REVIEWING = ["todo", "ok", "fix"];
/** In the middle of a stroke nothing else is kept. */
const IN_A_STROKE = ["escape", "smaller", "larger"];

/** Bind the keys; `page` holds the parts, `page.openSheet()` and `page.shownInfo()`. */
export function bindActions(page) {
  const { panel, editor, proposals, review, toolbar, picking, keyPoints, measurements } = page;
  const { session, view, scene } = panel;
  const choose = (name) => () => {
    if (all(`[data-tool=${name}]`)[0].hidden) return;
    proposals.discard();
    editor.choose(name);
  };
  toolbar.onTool((name) => choose(name)());
  const actions = {
    ...named(DRAWING, choose),
    ...named(PROPOSING, (key) => () => proposals.choose(key)),
    ...named(REVIEWING, (name) => () => review.set(name)),
    delete: () => picking.takeBack() || editor.remove(),
    pick: () => picking.toggle(),
    measure: () => measurements.openMenu(),
    smaller: () => toolbar.scaleBrush(1 / 1.25),
    larger: () => toolbar.scaleBrush(1.25),
    claim: () => toolbar.toggleClaim(),
    undo: () => undo(page),
    redo: () => (keyPoints.isMarking ? keyPoints : session).redo(),
    "new keypoint": () => {
      choose("keypoint")();
      keyPoints.begin();
    },
    enter: () => picking.finish() || proposals.apply() || editor.accept() || review.accept(),
    escape: () => picking.stop() || editor.cancel() || proposals.discard() || editor.choose("vertex"),
    excluded: () => review.set(page.shownInfo()?.state === "excluded" ? "todo" : "excluded"),
    "page up": () => review.leaf(-1),
    "page down": () => review.leaf(1),
    "zoom in": () => view.zoom(1.25),
    "zoom out": () => view.zoom(1 / 1.25),
    fit: () => toolbar.fit(true),
    ghost: () => panel.toggleLayer("ghost"),
    overlay: () => panel.toggleLayer("hull"),
    shadow: () => panel.toggleLayer("shadow"),
    sheet: page.openSheet,
  };
  const hide = (isHidden) => {
    scene.isHidden = isHidden;
    panel.redraw();
  };
  bindShortcuts(actions, hide, (name) => !session.isBusy || IN_A_STROKE.includes(name));
}

/** One step back: of the marks, the last point of what is being drawn, or else the last edit. */
function undo({ panel, editor, proposals, keyPoints }) {
  if (keyPoints.isMarking) keyPoints.undo();
  else if (panel.scene.draft) editor.remove();
  else {
    proposals.discard();
    panel.session.undo();
  }
}

const named = (names, make) => Object.fromEntries(names.map((name) => [name, make(name)]));
