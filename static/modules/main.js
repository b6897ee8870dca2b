// The page: one state from the server, shown in every part.

import { Banner } from "./banner.js";
import { Carving } from "./carving.js";
import { Detection } from "./detection.js";
import { DynamicRange } from "./dynamic-range.js";
import { Editor } from "./editor.js";
import { FramePanel } from "./frame-panel.js";
import { showHull } from "./hull-view.js";
import { resizablePanes } from "./panes.js";
import { Proposals } from "./proposals.js";
import { Review } from "./review.js";
import { download, fileName } from "./screenshot.js";
import { getJson, keepLinked, send } from "./server.js";
import { bindShortcuts, fillSheet } from "./shortcuts.js";
import { listenInSpace } from "./space-keys.js";
import { showSource } from "./source-view.js";
import { Tabs } from "./tabs.js";
import { Toolbar } from "./toolbar.js";
import { Transport } from "./transport.js";

const part = (id) => document.getElementById(id);

let state = null;
let newestSerial = -1;
let frameOnShow = "";
let isFetching = false;
let linkWasLost = false;
let complaint = "";

const tabs = new Tabs(document.querySelectorAll("[role=tab]"));
const banner = new Banner(part("banner"));
const panel = new FramePanel(showEditing, complain, showFrame);
const { session, view, scene } = panel;
const editor = new Editor(part("frame-canvas"), view, session, scene, {
  redraw: () => panel.redraw(),
  complain,
  onStart: stay,
  onTool: () => toolbar?.update(),
  onSeed: (row, column) => proposals.seed(row, column),
});
const dynamicRange = new DynamicRange(view);
const toolbar = new Toolbar(panel, editor, () => state?.window_m ?? null);
const proposals = new Proposals(
  {
    list: part("tool-list"),
    form: part("tool-form"),
    settings: part("tool-settings"),
    hint: part("tool-hint"),
    complaint: part("tool-complaint"),
    apply: part("tool-apply"),
    discard: part("tool-discard"),
    all: part("tool-all"),
  },
  session,
  {
    show: showProposal,
    open: () => {
      tabs.open("tools");
      stay();
    },
    seeding: (isSeeding) => {
      if (isSeeding !== (editor.toolName === "grow")) editor.choose(isSeeding ? "grow" : "vertex");
    },
  },
);
new Detection({
  settings: () => proposals.thresholdSettings(),
  show: (next) => {
    proposals.discard();
    showState(next);
  },
  complain,
});
const review = new Review(
  {
    buttons: [...document.querySelectorAll("#review button[data-state]")],
    accept: part("accept"),
    count: part("review-count"),
  },
  (number, name) => command("PUT", `/api/frames/${number}/state`, { state: name }),
  showFrame,
);
const carving = new Carving(
  {
    form: part("carving"),
    rule: part("carving-rule"),
    misses: part("carving-misses"),
    spacing: part("carving-spacing"),
    preview: part("preview-chip"),
    threshold: part("threshold"),
    revision: part("revision"),
    emptied: part("emptied"),
  },
  {
    set: (changes) => command("PUT", "/api/carving", changes),
    exclude: excludeAll,
    go: showFrame,
  },
);
const transport = new Transport(
  {
    play: part("play"),
    step: part("step"),
    restart: part("restart"),
    speed: part("speed"),
    cells: part("cells"),
    follow: part("follow"),
    text: part("reel-text"),
  },
  (body) => command("POST", "/api/playback", body),
  (frame) => command("POST", "/api/shown", { frame }),
  () => editor.spaceMovedPicture,
);

async function command(method, path, body) {
  try {
    complaint = "";
    showState(await send(method, path, body));
  } catch (error) {
    complain(error.message);
    if (state) carving.update(state);
  }
}

function showFrame(number) {
  return command("POST", "/api/shown", { frame: number === state.frames ? null : number });
}

/** Stay with the frame that somebody edits while others arrive. */
function stay() {
  if (state?.following && state.status === "playing") {
    command("POST", "/api/shown", { frame: session.frame.number });
  }
}

async function excludeAll(numbers) {
  for (const number of numbers) {
    await command("PUT", `/api/frames/${number}/state`, { state: "excluded" });
  }
}

function complain(sentence) {
  complaint = sentence;
  showBanner();
}

function showState(next) {
  // The answer to an order may arrive after the news of what followed it.
  if (next.serial < newestSerial) return;
  newestSerial = next.serial;
  state = next;
  showSource(state);
  showHull(state);
  showBanner();
  carving.update(state);
  review.update(state);
  transport.update(state);
  panel.follow(state);
  proposals.beginWith(state.extraction);
  toolbar.offerLabels(state.frames_info);
  bringFrame();
}

/** Fetch and show the frame that the state names; one at a time, always ending at the latest. */
async function bringFrame() {
  if (isFetching || session.isBusy) return;
  isFetching = true;
  try {
    while (state.shown !== null && frameOnShow !== frameKey()) await fetchFrame(frameKey());
    if (state.shown === null) {
      frameOnShow = "";
      panel.clear();
    } else if (session.isBehind(state.frames_info?.[state.shown - 1]?.revision)) {
      await session.refresh();
    }
  } catch (error) {
    if (!linkWasLost) complain(error.message);
  } finally {
    isFetching = false;
  }
}

const frameKey = () => `${state.run}/${state.shown}`;

async function fetchFrame(key) {
  const [run, number] = key.split("/").map(Number);
  let answer;
  try {
    answer = await panel.fetch(number);
  } catch (error) {
    if (run === state.run) throw error;
  }
  // Restarted in the meantime: the frame belongs to a run that is over.
  if (run !== state.run) return;
  frameOnShow = key;
  proposals.discard();
  editor.cancel();
  toolbar.keepWindow();
  panel.take(...answer);
  dynamicRange.take(answer[1]);
}

function showEditing() {
  toolbar?.update();
  proposals?.update();
  showBanner();
  // News that came while somebody was drawing has waited.
  if (state) bringFrame();
}

function showProposal(rings) {
  scene.proposal = rings;
  panel.redraw();
}

function showBanner() {
  const lost = "The connection to the server is lost; trying again. What is on screen may be old.";
  const { conflict } = session;
  if (linkWasLost) banner.show(lost);
  else if (conflict) {
    const what = conflict.isUnsaved
      ? `Your outline of frame ${conflict.number} was not saved: the server did not answer.`
      : `Frame ${conflict.number} was changed on another page meanwhile.`;
    banner.show(`${what} The kept outline is on show, yours is the dashed one.`, [
      ["Keep mine", () => session.keepMine()],
      ["Take theirs", () => session.keepTheirs()],
    ]);
  } else if (state?.message) banner.show(state.message);
  else banner.show(complaint, [["Dismiss", () => complain("")]]);
}

function showLink(link) {
  part("link").textContent = link === "lost" ? "connection lost" : link;
  part("link").dataset.link = link;
  if (link === "connected" && linkWasLost) {
    frameOnShow = "";
    newestSerial = -1;
    complaint = "";
    // viser's client tries again only while its frame has the focus.
    part("viewport").contentWindow.location.reload();
  }
  linkWasLost = link === "lost";
  showBanner();
}

function openSheet() {
  part("sheet").showModal();
}

/** One step back: the last point of what is being drawn, or else the last edit. */
function undo() {
  if (scene.draft) editor.remove();
  else {
    proposals.discard();
    session.undo();
  }
}

function savePicture() {
  const { name } = state.source;
  download(panel.picture(name), fileName(name, session.frame.number));
}

/** Take an excluded frame back in, or exclude it. */
function toggleExcluded() {
  const info = state?.frames_info?.[state.shown - 1];
  review.set(info?.state === "excluded" ? "todo" : "excluded");
}

function enter() {
  if (!proposals.apply() && !editor.accept()) review.accept();
}

function escape() {
  if (!editor.cancel() && !proposals.discard()) editor.choose("vertex");
}

const chooseTool = (name) => () => {
  if (document.querySelector(`[data-tool=${name}]`).hidden) return;
  proposals.discard();
  editor.choose(name);
};
const drawing = ["vertex", "polygon", "lasso", "brush", "eraser", "livewire"];
const proposing = ["threshold", "grow", "snap", "copy previous", "copy next", "reprojection"];
const reviewing = ["todo", "ok", "fix"];
const named = (names, make) => Object.fromEntries(names.map((name) => [name, make(name)]));

toolbar.onTool((name) => chooseTool(name)());
bindShortcuts(
  {
    ...named(drawing, chooseTool),
    ...named(proposing, (key) => () => proposals.choose(key)),
    ...named(reviewing, (name) => () => review.set(name)),
    delete: () => editor.remove(),
    smaller: () => toolbar.scaleBrush(1 / 1.25),
    larger: () => toolbar.scaleBrush(1.25),
    claim: () => toolbar.toggleClaim(),
    undo,
    redo: () => session.redo(),
    enter,
    escape,
    excluded: toggleExcluded,
    "page up": () => review.leaf(-1),
    "page down": () => review.leaf(1),
    "zoom in": () => view.zoom(1.25),
    "zoom out": () => view.zoom(1 / 1.25),
    fit: () => toolbar.fit(true),
    ghost: () => panel.toggleLayer("ghost"),
    overlay: () => panel.toggleLayer("hull"),
    shadow: () => panel.toggleLayer("shadow"),
    sheet: openSheet,
  },
  (isHidden) => {
    scene.isHidden = isHidden;
    panel.redraw();
  },
  // Nothing is kept in the middle of a stroke.
  (name) => !session.isBusy || ["escape", "smaller", "larger"].includes(name),
);
part("save-picture").addEventListener("click", savePicture);
// A button that was pressed with the pointer leaves the keys to the picture.
document.addEventListener("click", (event) => {
  if (event.detail > 0 && event.target.closest(".frame button, .tool-list button")) {
    part("frame-canvas").focus({ preventScroll: true });
  }
});
fillSheet(part("sheet-groups"));
part("open-sheet").addEventListener("click", openSheet);
listenInSpace(part("viewport"), (event) => {
  if (event.key === "Escape") part("frame-canvas").focus();
  else transport.onKeyInSpace(event);
});
resizablePanes(document.querySelector("main"), {
  first: part("separator-first"),
  third: part("separator-third"),
});
const [tools] = await Promise.all([getJson("/api/tools"), dynamicRange.chooseColours()]);
proposals.offer(tools);
toolbar.offer(tools);
toolbar.update();
keepLinked(showState, showLink);
