// The page: one state from the server, shown in every part.

import { bindActions } from "./actions.js";
import { PARTS, part } from "./elements.js";
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
import { Notices } from "./notices.js";
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
import { fillSheet } from "./shortcuts.js";
import { Share } from "./share.js";
import { listenInSpace } from "./space-keys.js";
import { showSource } from "./source-view.js";
import { SpaceView } from "./space-view.js";
import { Tabs } from "./tabs.js";
import { Timeline } from "./timeline.js";
import { Toolbar } from "./toolbar.js";
import { Transport } from "./transport.js";

let state = null;
let newestSerial = -1;
let frameOnShow = "";
let isFetching = false;
let isAnew = false;

const tabs = new Tabs(document.querySelectorAll("[role=tab]"));
const panel = new FramePanel(showEditing, complain, showFrame);
const { session, view, scene } = panel;
const notices = new Notices(session, {
  restart: () => command("POST", "/api/playback", { action: "restart" }),
  choosePass: () => loading.choosePass(),
});
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
  PARTS.proposals,
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
    set: () => detection.update(),
  },
);
const detection = new Detection({
  settings: () => proposals.thresholdSettings(),
  show: (next) => {
    proposals.discard();
    showState(next);
  },
  complain,
});
const review = new Review(
  PARTS.review,
  (number, name) => command("PUT", `/api/frames/${number}/state`, { state: name }),
  showFrame,
);
const carving = new Carving(
  PARTS.carving,
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
  PARTS.transport,
  (body) => command("POST", "/api/playback", body),
  (frame) => command("POST", "/api/shown", { frame }),
  () => editor.spaceMovedPicture,
);
const timeline = new Timeline(PARTS.timeline, showFrame);

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
    notices.forget();
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

function complain(sentence, kind) {
  notices.complain(sentence, kind);
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
  notices.update(state);
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
  detection.update(state);
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
    if (!notices.isLinkLost) complain(error.message);
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
  notices?.show();
  showSaved(session, notices?.isLinkLost);
  // News that came while somebody was drawing has waited.
  if (state) bringFrame();
}

function showProposal(rings) {
  scene.proposal = rings;
  panel.redraw();
}

function showLink(link) {
  part("link").textContent = link === "lost" ? "connection lost" : link;
  part("link").dataset.link = link;
  if (link === "connected" && notices.isLinkLost) {
    frameOnShow = "";
    newestSerial = -1;
    notices.forget();
    isAnew = true;
    space.reconnect();
  }
  notices.isLinkLost = link === "lost";
  exporting.setLost(notices.isLinkLost);
  notices.show();
  showSaved(session, notices.isLinkLost);
}

const openSheet = () => part("sheet").showModal();

function savePicture() {
  const { name } = state.source;
  download(panel.picture(name), fileName(name, session.frame.number));
}

bindActions({
  ...{ panel, editor, proposals, review, toolbar, picking, keyPoints, measurements, openSheet },
  shownInfo: () => state?.frames_info?.[state.shown - 1],
});
part("save-picture").addEventListener("click", savePicture);
// A button that was pressed with the pointer leaves the keys to the picture.
document.addEventListener("click", (event) => {
  const { target } = event;
  if (event.detail > 0 && target instanceof Element && target.closest(".frame button, .tool-list button, .history button")) {
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
