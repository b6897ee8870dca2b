// Keys: one table for what they do and for the sheet that names them.

import { tinykeys } from "../vendor/tinykeys.js";

/** [group, [[name of the action, keys for people, bindings, what it does], …]]; no binding: told only.
 * @type {[string, [string | null, string, string[], string][]][]}
 */
const GROUPS = [
  ["Outline", [
    ["vertex", "V", ["v"], "Edit vertices: drag; a middle handle puts one in"],
    [null, "Shift drag", [], "Pull neighbours along, as far as the brush is wide"],
    ["delete", "Del", ["Delete", "Backspace"], "Take out the vertex, or the last point drawn"],
    [null, "Alt click", [], "Take out a vertex"],
    ["polygon", "P", ["p"], "Draw a polygon; Enter or the first point closes it"],
    ["lasso", "A", ["a"], "Draw around a region"],
    ["brush", "B", ["b"], "Paint"],
    ["eraser", "E", ["e"], "Rub out"],
    ["smaller", "[", ["["], "Smaller brush"],
    ["larger", "]", ["]"], "Larger brush"],
    ["livewire", "L", ["l"], "Follow an edge from point to point"],
    ["claim", "K", ["k"], "Lit side only, or complete outline"],
    ["undo", "Ctrl Z", ["$mod+z"], "Undo on this frame; with nothing to undo here, go to the last edit"],
    ["redo", "Ctrl Shift Z", ["$mod+Shift+z", "$mod+y"], "Redo, likewise"],
  ]],
  ["Key points", [
    ["keypoint", "J", ["j"], "Mark the active key point; drag its cross to adjust it"],
    ["new keypoint", "Shift J", ["Shift+j"], "Begin another key point"],
    [null, "Del", [], "Take its mark in this frame away"],
    [null, "Ctrl Z", [], "With this tool: undo on key points, not on the outline"],
  ]],
  ["Proposals", [
    ["threshold", "T", ["t"], "Detect anew by a threshold"],
    ["grow", "F", ["f"], "Fill a region that grows from a point"],
    ["snap", "S", ["s"], "Snap to the edge"],
    ["copy previous", "C", ["c"], "Copy the previous frame's outline"],
    ["copy next", "Shift C", ["Shift+c"], "Copy the next frame's outline"],
    ["reprojection", "U", ["u"], "Begin from the hull as this frame sees it"],
    ["enter", "Enter", ["Enter"], "Apply the proposal"],
    ["escape", "Esc", ["Escape"], "Discard it; give up what is being drawn"],
  ]],
  ["Review", [
    ["todo", "1", ["1"], "To do"],
    ["ok", "2", ["2"], "OK"],
    ["fix", "3", ["3"], "To fix"],
    ["excluded", "X", ["x"], "Exclude from the hull, or take back in: what if without it?"],
    [null, "Enter", [], "Accept and go to the next frame to do"],
    ["page up", "Page Up", ["PageUp"], "Previous frame"],
    ["page down", "Page Down", ["PageDown"], "Next frame"],
  ]],
  ["Picture", [
    [null, "Wheel", [], "Zoom about the cursor"],
    [null, "Space drag", [], "Move the picture"],
    ["zoom in", "+", ["Equal", "Shift+Equal", "NumpadAdd"], "Zoom in"],
    ["zoom out", "−", ["Minus", "NumpadSubtract"], "Zoom out"],
    ["fit", "0", ["0", "Numpad0"], "Fit the target"],
    ["ghost", "G", ["g"], "Outline of the neighbouring frame"],
    ["overlay", "R", ["r"], "The hull as this frame sees it, and where they disagree"],
    ["shadow", "D", ["d"], "What lies in the dark behind a lit side"],
    [null, "H held", [], "Hide all that lies over the picture"],
  ]],
  ["Measurements", [
    ["measure", "N", ["n"], "Add a measurement that needs no pick"],
    ["pick", "M", ["m"], "Measure by clicks on the hull, or stop"],
    [null, "Shift click", [], "While measuring: the farthest point near there"],
    [null, "Ctrl click", [], "The nearest end of the part"],
    [null, "Enter", [], "End a polyline"],
    [null, "Backspace", [], "Take the last point back"],
    [null, "Esc", [], "Stop measuring"],
  ]],
  ["Playback and space", [
    [null, "Space", [], "Play or pause"],
    [null, "→", [], "Next frame, or step"],
    [null, "←", [], "Previous frame"],
    [null, "Drag, wheel", [], "In the view in space: turn, right drag moves, zoom"],
    [null, "Esc", [], "From the view in space back to the picture"],
    ["sheet", "?", ["?", "Shift+?"], "This sheet"],
  ]],
];

const NAVIGATION = /^(Arrow|Page|Home|End)/;

/** Bind the table's keys to `actions` by name, where `isFree(name)`; H held calls `onHide(bool)`. */
export function bindShortcuts(actions, onHide, isFree) {
  /** @type {Record<string, (event: KeyboardEvent) => void>} */
  const bindings = {};
  for (const [name, , keys] of GROUPS.flatMap(([, rows]) => rows)) {
    for (const key of keys) {
      bindings[key] = (event) => {
        if (event.defaultPrevented || isTaken(event)) return;
        event.preventDefault();
        if (isFree(name)) actions[name](event);
      };
    }
  }
  tinykeys(window, bindings);
  addEventListener("keydown", (event) => {
    if (event.code === "KeyH" && !event.ctrlKey && !event.metaKey && !isTaken(event)) onHide(true);
  });
  addEventListener("keyup", (event) => event.code === "KeyH" && onHide(false));
  addEventListener("blur", () => onHide(false));
}

/** Every binding of the table, so that a test can tell that none is there twice. */
export function allBindings() {
  return GROUPS.flatMap(([, rows]) => rows.flatMap(([, , keys]) => keys));
}

/** Whether a key belongs to what has the focus: somebody types, or a control uses it itself. */
export function isTaken(event) {
  const { target } = event;
  if (document.querySelector("dialog[open]")) return true;
  if (target.matches?.("input[type=range]")) return NAVIGATION.test(event.key);
  if (target.closest?.("input, select, textarea, [contenteditable]")) return true;
  return Boolean(target.closest?.("a[href], button, summary, [role=tab]")) && [" ", "Enter"].includes(event.key);
}

/** Fill the sheet of shortcuts. */
export function fillSheet(place) {
  place.replaceChildren(...GROUPS.map(([title, rows]) => {
    const group = document.createElement("section");
    const heading = document.createElement("h3");
    const list = document.createElement("dl");
    heading.textContent = title;
    list.append(...rows.map(([, keys, , what]) => sheetRow(keys, what)));
    group.append(heading, list);
    return group;
  }));
}

function sheetRow(keys, what) {
  const row = document.createElement("div");
  const term = document.createElement("dt");
  const text = document.createElement("dd");
  const names = /^(Page|Alt|Space d|Drag|H held)/.test(keys) ? [keys] : keys.split(" ");
  term.append(...names.map((name) => Object.assign(document.createElement("kbd"), { textContent: name })));
  text.textContent = what;
  row.append(term, text);
  return row;
}
