// The page: one state from the server, shown in every part.

import { Banner } from "./banner.js";
import { ExportMenu } from "./export-menu.js";
import { Carving } from "./carving.js";
import { Detection } from "./detection.js";
import { DynamicRange } from "./dynamic-range.js";
import { Editor } from "./editor.js";
import { FramePanel } from "./frame-panel.js";
import { showHull } from "./hull-view.js";
import { resizablePanes } from "./panes.js";
import { Loading } from "./loading.js";
import { Measurements } from "./measurements.js";
import { Parts } from "./parts.js";
import { showParts } from "./parts-view.js";
import { Picking } from "./picking.js";
import { Proposals } from "./proposals.js";
import { showSaved } from "./saved-view.js";
import { Review } from "./review.js";
import { download, fileName } from "./screenshot.js";
import { KeyPoints } from "./key-points.js";
import { getJson, keepLinked, send } from "./server.js";
import { ReferenceView } from "./reference-view.js";
import { RightPane } from "./right-pane.js";
import { bindShortcuts, fillSheet } from "./shortcuts.js";
import { Share } from "./share.js";
import { listenInSpace } from "./space-keys.js";
import { fewViewsText, showSource } from "./source-view.js";
import { SpaceView } from "./space-view.js";
import { Tabs } from "./tabs.js";
import { Timeline } from "./timeline.js";
import { Toolbar } from "./toolbar.js";
import { Transport } from "./transport.js";

const part = (id) => document.getElementById(id);

let state = null;
let newestSerial = -1;
let frameOnShow = "";
let isFetching = false;
let linkWasLost = false;
let complaint = "";
let complaintKind = "bad";
let isAnew = false;
let dismissed = "";

const tabs = new Tabs(document.querySelectorAll("[role=tab]"));
const banner = new Banner(part("banner"));
const panel = new FramePanel(showEditing, complain, showFrame);
const { session, view, scene } = panel;
const rightPane = new RightPane({ go: showFrame });
const keyPoints = new KeyPoints({ redraw: () => panel.redraw(), complain, go: showFrame, open: () => tabs.open("tools") });
const measurements = new Measurements({ open: () => tabs.open("measurements") });
const editor = new Editor(part("frame-canvas"), view, session, scene, {
  redraw: () => panel.redraw(),
  complain,
  onStart: stay,
  onTool: (name) => {
    toolbar?.update();
    keyPoints.setMarking(name === "keypoint");
  },
  keyPoints,
  onSeed: (row, column) => proposals.seed(row, column),
});
panel.keyPoints = () => ({
  marks: keyPoints.marks(),
  expected: keyPoints.expected(),
  active: keyPoints.active,
  isMarking: keyPoints.isMarking,
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
    side: part("carving-side"),
    first: part("carving-first"),
    last: part("carving-last"),
    complaint: part("carving-complaint"),
    hullRevision: part("hull-revision"),
    preview: part("preview-chip"),
    threshold: part("threshold"),
    revision: part("revision"),
    emptied: part("emptied"),
  },
  {
    set: (changes) => rightPane.greyUntil(send("PUT", "/api/carving", changes).then(showState)),
    exclude: excludeAll,
    go: showFrame,
  },
);
const parts = new Parts(session, {
  leave: () => {
    proposals.discard();
    editor.cancel();
  },
  show: showState,
  complain,
});
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
const timeline = new Timeline(
  {
    course: part("course"),
    plots: part("course-plots"),
    readout: part("course-readout"),
    note: part("course-note"),
    toggle: part("toggle-plots"),
  },
  showFrame,
);

const loading = new Loading({
  complain,
  isBusy: () => session.isBusy || session.isSaving,
  hasConflict: () => session.conflict !== null,
  state: () => state,
});
const exporting = new ExportMenu(part("export-menu"), part("export-note"));

const space = new SpaceView(complain);
const picking = new Picking(space, complain);
const reference = new ReferenceView(space, complain);
const share = new Share(space, panel, { showFrame, complain });

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

function complain(sentence, kind = "bad") {
  complaint = sentence;
  complaintKind = kind;
  showBanner();
}

function showState(next) {
  // The answer to an order may arrive after the news of what followed it.
  if (next.serial < newestSerial) return;
  newestSerial = next.serial;
  const before = state;
  state = next;
  if (before && before.source.key !== state.source.key) forgetSource(before);
  showSource(state);
  showHull(state);
  showParts(state);
  showBanner();
  loading.update(state);
  exporting.update(state);
  carving.update(state);
  rightPane.update(state);
  measurements.update(state);
  review.update(state);
  transport.update(state);
  timeline.update(state);
  panel.follow(state);
  proposals.beginWith(state.extraction);
  keyPoints.update(state);
  parts.update(state);
  space.update(state);
  picking.update(state);
  reference.update(state);
  share.update(state);
  bringFrame();
}

/** Another source was loaded, here or elsewhere, or the server was started anew. */
function forgetSource(before) {
  const hadEdits = session.conflict || (before.frames_info ?? []).some((info) => info.edited);
  const why = isAnew ? "The server was started anew" : `${state.source.name} was loaded`;
  const isTold = hadEdits && !loading.isOwn(state);
  complain(isTold ? `${why}: the edits of ${before.source.name} are gone.` : "");
  isAnew = false;
  frameOnShow = "";
  session.component = "target";
  session.clear();
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
    } else if (session.isBehind(state.frames_info?.[state.shown - 1])) {
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
  keyPoints?.follow(session.frame);
  parts?.update();
  rightPane.greyWhile(session.isSaving);
  proposals?.update();
  showBanner();
  showSaved(session, linkWasLost);
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
  if (linkWasLost) {
    const kept = `Your outline of frame ${conflict?.number} is kept on this page, not saved yet.`;
    banner.show(conflict?.isUnsaved ? `${lost} ${kept}` : lost);
  } else if (conflict) {
    const what = conflict.isUnsaved
      ? `Your outline of frame ${conflict.number} was not saved: the server did not answer.`
      : `Frame ${conflict.number} was changed on another page meanwhile.`;
    banner.show(`${what} The kept outline is on show, yours is the dashed one.`, [
      ["Keep mine", () => session.keepMine()],
      ["Take theirs", () => session.keepTheirs()],
    ]);
  } else if (complaint) banner.show(complaint, [["Dismiss", () => complain("")]], complaintKind);
  else if (state?.message && dismissed !== noticeKey()) showFailure();
  else if (state && fewViewsText(state) && dismissed !== noticeKey()) {
    banner.show(fewViewsText(state), [["Dismiss", dismiss]], "note");
  } else banner.show("");
}

const noticeKey = () => `${state.source.key}/${state.run}`;

function dismiss() {
  dismissed = noticeKey();
  showBanner();
}

/** What a program says, as a person writes it. */
function sentence(text) {
  return `${text.charAt(0).toUpperCase()}${text.slice(1).replace(/[.!?]*$/, "")}.`;
}

function showFailure() {
  const { message, frames } = state;
  const kept = frames === 0 ? "" : ` The ${frames === 1 ? "frame" : `${frames} frames`} before that can still be edited and measured.`;
  banner.show(`${sentence(message)}${kept}`, [
    ["Try again", () => command("POST", "/api/playback", { action: "restart" })],
    ["Open another pass…", () => loading.choosePass()],
    ["Dismiss", dismiss],
  ]);
}

function showLink(link) {
  part("link").textContent = link === "lost" ? "connection lost" : link;
  part("link").dataset.link = link;
  if (link === "connected" && linkWasLost) {
    frameOnShow = "";
    newestSerial = -1;
    complaint = "";
    isAnew = true;
    space.reconnect();
  }
  linkWasLost = link === "lost";
  exporting.setLost(linkWasLost);
  showBanner();
  showSaved(session, linkWasLost);
}

function openSheet() {
  part("sheet").showModal();
}

/** One step back: the last point of what is being drawn, or else the last edit. */
function undo() {
  if (keyPoints.isMarking) keyPoints.undo();
  else if (scene.draft) editor.remove();
  else {
    proposals.discard();
    session.undo();
  }
}

function redo() {
  if (keyPoints.isMarking) keyPoints.redo();
  else session.redo();
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
  if (!picking.finish() && !proposals.apply() && !editor.accept()) review.accept();
}

function escape() {
  if (!picking.stop() && !editor.cancel() && !proposals.discard()) editor.choose("vertex");
}

const chooseTool = (name) => () => {
  if (document.querySelector(`[data-tool=${name}]`).hidden) return;
  proposals.discard();
  editor.choose(name);
};
const drawing = ["vertex", "polygon", "lasso", "brush", "eraser", "livewire", "keypoint"];
const proposing = ["threshold", "grow", "snap", "copy previous", "copy next", "reprojection"];
const reviewing = ["todo", "ok", "fix"];
const named = (names, make) => Object.fromEntries(names.map((name) => [name, make(name)]));

toolbar.onTool((name) => chooseTool(name)());
bindShortcuts(
  {
    ...named(drawing, chooseTool),
    ...named(proposing, (key) => () => proposals.choose(key)),
    ...named(reviewing, (name) => () => review.set(name)),
    delete: () => picking.takeBack() || editor.remove(),
    pick: () => picking.toggle(),
    smaller: () => toolbar.scaleBrush(1 / 1.25),
    larger: () => toolbar.scaleBrush(1.25),
    claim: () => toolbar.toggleClaim(),
    undo,
    redo,
    "new keypoint": () => {
      chooseTool("keypoint")();
      keyPoints.begin();
    },
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
    measure: () => measurements.openMenu(),
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
  if (event.detail > 0 && event.target.closest(".frame button, .tool-list button, .history button")) {
    part("frame-canvas").focus({ preventScroll: true });
  }
});
fillSheet(part("sheet-groups"));
part("open-sheet").addEventListener("click", openSheet);
part("stop-imaging").addEventListener("click", () => command("POST", "/api/playback", { action: "pause" }));
loading.takeDropsOn(part("viewport"));
listenInSpace(part("viewport"), (event) => {
  if (picking.onKeyInSpace(event)) return;
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
