// The page: one state from the server, shown in every part.

import {
  afterFrames,
  frameRows,
  hullRows,
  showExtents,
  showLines,
  showNote,
  showRows,
  showUnobserved,
} from "./facts-view.js";
import { FrameView } from "./frame-view.js";
import { frames, views, withUnit } from "./numbers.js";
import { getJson, getLevels, keepLinked, order } from "./server.js";
import { Transport } from "./transport.js";

const part = (id) => document.getElementById(id);

let state = null;
let newestSerial = -1;
let frameOnShow = "";
let isFetching = false;
let linkWasLost = false;
let complaint = "";

const frameView = new FrameView(part("frame-canvas"), showReading);
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
  (body) => command("/api/playback", body),
  (frame) => command("/api/shown", { frame }),
);

async function command(path, body) {
  try {
    complaint = "";
    showState(await order(path, body));
  } catch (error) {
    complaint = error.message;
    showBanner();
  }
}

function showState(next) {
  // The answer to an order may arrive after the news of what followed it.
  if (next.serial < newestSerial) return;
  newestSerial = next.serial;
  state = next;
  part("source-name").textContent = state.source.name;
  part("source-description").textContent = state.source.description;
  part("source").title = state.source.description;
  document.title = `${state.source.name} – radarhull`;
  part("status").textContent = statusText();
  part("status").dataset.status = state.status;
  showProgress();
  showHull();
  showBanner();
  transport.update(state);
  bringFrame();
}

function statusText() {
  const { status, source } = state;
  const total = source.expected_frames;
  const place = total === null ? `frame ${state.frames}` : `frame ${state.frames} of ${total}`;
  return {
    preparing: `Preparing ${source.name}…`,
    playing: `Imaging ${place}`,
    paused: state.frames === 0 ? "Paused before the first frame" : `Paused at ${place}`,
    finished: `All ${frames(state.frames)} received`,
    failed: state.frames === 0 ? "Failed before the first frame" : `Failed after ${place}`,
  }[status];
}

function showProgress() {
  const bar = part("progress");
  const total = state.source.expected_frames;
  bar.hidden = total === null;
  if (state.status === "preparing") bar.removeAttribute("value");
  else if (total !== null) bar.value = state.frames / total;
}

function showHull() {
  const { hull } = state;
  const waiting = state.status === "failed" ? "No frame arrived." : "Preparing the first frame…";
  part("hull-body").hidden = hull === null || hull.is_empty;
  part("hull-empty").hidden = hull !== null && !hull.is_empty;
  part("hull-empty").textContent = noHullText();
  part("hull-stamp").textContent = hull === null ? "" : afterFrames(hull.frames);
  part("space-empty").hidden = hull !== null;
  part("space-empty").textContent = waiting;
  part("space-stamp").textContent = spaceText();
  part("hull-body").dataset.frames = hull?.frames ?? 0;
  part("hull-body").dataset.run = state.run;
  if (hull === null || hull.is_empty) return;
  showExtents(part("extents"), hull.extents);
  showLines(part("lines"), hull.lines);
  part("lines-empty").hidden = hull.lines.length > 0;
  showUnobserved(part("unobserved"), hull.unobserved);
  showRows(part("hull-facts"), hullRows(hull, state.light));
}

function noHullText() {
  if (state.hull === null) return "The hull appears with the first frame.";
  if (state.hull.views === 0) return "There is no hull: no frame so far shows the target.";
  return "The hull is empty: no point of the target lies inside every silhouette.";
}

function spaceText() {
  if (state.hull === null) return "";
  return `hull of ${views(state.hull.views)}, picture of frame ${state.shown}`;
}

/** Fetch and show the frame that the state names; one at a time, always ending at the latest. */
async function bringFrame() {
  if (isFetching) return;
  isFetching = true;
  try {
    while (state.shown !== null && frameOnShow !== frameKey()) await fetchFrame(frameKey());
    if (state.shown === null) clearFrame();
  } catch (error) {
    if (!linkWasLost) complaint = error.message;
    showBanner();
  } finally {
    isFetching = false;
  }
}

const frameKey = () => `${state.run}/${state.shown}`;

async function fetchFrame(key) {
  const [run, number] = key.split("/").map(Number);
  let frame, levels;
  try {
    [frame, levels] = await Promise.all([getJson(`/api/frames/${number}`), getLevels(number)]);
  } catch (error) {
    if (run === state.run) throw error;
  }
  // Restarted in the meantime: the frame belongs to a run that is over.
  if (run !== state.run) return;
  frameOnShow = key;
  frameView.setWindow(part("zoom-target").ariaPressed === "true" ? state.window_m : null);
  frameView.setFrame(frame, levels);
  part("frame-empty").hidden = true;
  part("frame-stamp").textContent = frameStamp(frame);
  showNote(part("frame-note"), frame.note);
  part("frame-canvas").dataset.frame = number;
  showRows(part("frame-facts"), frameRows(frame));
}

function frameStamp({ number, label, time_s: time }) {
  return [number, label, withUnit(time, 1, "s")].filter(Boolean).join(", ");
}

function clearFrame() {
  frameOnShow = "";
  frameView.clear();
  part("frame-empty").hidden = false;
  part("frame-stamp").textContent = "";
  showNote(part("frame-note"), "");
  part("frame-canvas").dataset.frame = 0;
  part("frame-facts").replaceChildren();
}

function showReading(reading) {
  const output = part("readout");
  if (reading === null) {
    output.textContent = "Point at the picture to read it.";
    return;
  }
  const pairs = [
    ["range", reading.range],
    ["cross-range", reading.crossRange],
    ["level", reading.level],
  ];
  output.replaceChildren(
    ...pairs.flatMap(([name, value], index) => {
      const bold = document.createElement("b");
      bold.textContent = value;
      return [`${index ? " · " : ""}${name} `, bold];
    }),
  );
}

function showBanner() {
  const text = linkWasLost
    ? "The connection to the server is lost; trying again. What is on screen may be old."
    : state?.message || complaint;
  part("banner").textContent = text;
  part("banner").hidden = !text;
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

function chooseZoom(isTarget) {
  part("zoom-target").ariaPressed = String(isTarget);
  part("zoom-whole").ariaPressed = String(!isTarget);
  frameView.setWindow(isTarget ? state?.window_m ?? null : null);
}

part("zoom-target").addEventListener("click", () => chooseZoom(true));
part("zoom-whole").addEventListener("click", () => chooseZoom(false));
part("floor").addEventListener("input", (event) => {
  const decibels = Number(event.target.value);
  part("floor-value").textContent = withUnit(decibels, 0, "dB");
  frameView.setFloor(decibels);
});
part("viewport").addEventListener("load", () => transport.listenIn(part("viewport")));

frameView.setColours(await getJson("/api/colours"));
keepLinked(showState, showLink);
