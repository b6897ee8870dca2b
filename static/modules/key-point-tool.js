// The tool that marks the active key point in the frame on show.

import { between } from "./rings.js";

const REACH_PX = 10;

/** A press marks the active point, or takes hold of a mark; what is held is placed when let go. */
export function keyPointTool(editor) {
  const { view, scene } = editor;
  let grip = null;

  const points = () => editor.keyPoints;
  const hit = (place) => {
    const near = points().marks()
      .map((mark) => [between(editor.toCanvas(mark.row, mark.column), place), mark])
      .filter(([distance]) => distance < REACH_PX)
      .sort(([one], [other]) => one - other);
    return near[0]?.[1] ?? null;
  };

  return {
    name: "keypoint",
    cursor: "crosshair",
    down(event, place) {
      const mark = hit(place);
      const at = view.pixelAt(...place);
      if (mark) points().choose(mark.name);
      // What is taken hold of beside its middle does not jump there.
      grip = mark ? [mark.row - at[0], mark.column - at[1]] : [0, 0];
      if (mark && event.altKey) {
        grip = null;
        points().removeMark();
        return false;
      }
      if (!mark) points().draft(at);
      return true;
    },
    move(event, place) {
      if (!grip) {
        editor.setCursor(hit(place) ? "move" : "crosshair");
        return;
      }
      const [row, column] = view.pixelAt(...place);
      points().draft([row + grip[0], column + grip[1]]);
    },
    up() {
      if (grip) points().keep();
      grip = null;
    },
    cancel() {
      if (!grip) return false;
      grip = null;
      points().draft(null);
      return true;
    },
    remove: () => points().removeMark(),
    leave: () => { scene.hovered = null; },
  };
}
