// Play, pause, step, speed, restart, the row of frames, and the keys for them.

import { timeText, views } from "./numbers.js";
import { STATES } from "./review.js";

const AS_FAST_AS_COMPUTED = "max";
const TAP_MS = 500;

export class Transport {
  #state = null;
  #send;
  #show;
  #parts;

  #spaceSince = null;
  #isSpaceUsed;

  /**
   * Control playback through `send(order)` and choose the frame through `show(number or null)`;
   * `isSpaceUsed()` says whether the space bar moved the picture.
   */
  constructor(parts, send, show, isSpaceUsed) {
    this.#isSpaceUsed = isSpaceUsed;
    this.#parts = parts;
    this.#send = send;
    this.#show = show;
    parts.play.addEventListener("click", () => this.#togglePlay());
    parts.step.addEventListener("click", () => send({ action: "step" }));
    parts.restart.addEventListener("click", () => send({ action: "restart" }));
    parts.follow.addEventListener("click", () => show(null));
    parts.speed.addEventListener("change", () => send({ speed_hz: speedOf(parts.speed.value) }));
    parts.cells.addEventListener("click", (event) => this.#chooseCell(event));
    document.addEventListener("keydown", (event) => this.#onKey(event));
    document.addEventListener("keyup", (event) => event.code === "Space" && this.#onSpaceUp());
  }

  update(state) {
    this.#state = state;
    const { play, step, follow, text } = this.#parts;
    const isOver = state.status === "finished" || state.status === "failed";
    const isPlaying = state.status === "playing" || state.status === "preparing";
    play.classList.toggle("playing", isPlaying);
    play.querySelector("span").textContent = isPlaying ? "Pause" : "Play";
    play.disabled = isOver;
    step.disabled = isOver;
    follow.hidden = state.following;
    text.textContent = reelText(state);
    this.#updateSpeeds(state);
    this.#updateCells(state);
  }

  /** Space in the view in space plays and pauses too; its other keys move the camera. */
  onKeyInSpace(event) {
    if (event.code !== "Space" || event.repeat) return;
    event.preventDefault();
    this.#togglePlay();
  }

  #togglePlay() {
    if (this.#state === null || this.#parts.play.disabled) return;
    this.#send({ action: this.#state.status === "paused" ? "play" : "pause" });
  }

  #onKey(event) {
    const field = event.target.closest?.("input, select, button, textarea");
    if (event.ctrlKey || event.metaKey || event.altKey || this.#state === null) return;
    if (field?.matches("input, select, textarea") || event.target.closest?.("dialog")) return;
    if (event.code === "Space" && !field) this.#spaceSince ??= event.timeStamp;
    else if (event.code === "ArrowRight") this.#nextFrame();
    else if (event.code === "ArrowLeft") this.#previousFrame();
    else return;
    event.preventDefault();
  }

  /** The space bar plays and pauses when tapped; held it moves the picture. */
  #onSpaceUp() {
    const isTapped = this.#spaceSince !== null && performance.now() - this.#spaceSince < TAP_MS;
    this.#spaceSince = null;
    if (isTapped && !this.#isSpaceUsed()) this.#togglePlay();
  }

  #nextFrame() {
    const { following, shown, frames: received } = this.#state;
    if (!following) this.#show(shown + 1 < received ? shown + 1 : null);
    else if (!this.#parts.step.disabled) this.#send({ action: "step" });
  }

  #previousFrame() {
    if (this.#state.shown > 1) this.#show(this.#state.shown - 1);
  }

  #chooseCell(event) {
    const number = Number(event.target.dataset.number);
    if (number) this.#show(number === this.#state.frames ? null : number);
  }

  #updateSpeeds(state) {
    const { speed } = this.#parts;
    const offered = [...new Set([...state.speeds_hz, state.speed_hz])];
    if (speed.options.length !== offered.length) {
      speed.replaceChildren(...offered.map((hertz) => new Option(speedText(hertz), speedKey(hertz))));
    }
    speed.value = speedKey(state.speed_hz);
  }

  #updateCells(state) {
    const { cells } = this.#parts;
    const wanted = Math.max(state.source.expected_frames ?? 0, state.frames);
    while (cells.children.length > wanted) cells.lastChild.remove();
    while (cells.children.length < wanted) cells.append(document.createElement("div"));
    [...cells.children].forEach((cell, index) => updateCell(cell, index + 1, state));
    const shown = cells.children[(state.shown ?? 0) - 1];
    if (shown) cells.setAttribute("aria-activedescendant", shown.id);
  }
}

function updateCell(cell, number, state) {
  const isReceived = number <= state.frames;
  cell.className = isReceived ? "received" : "";
  cell.classList.toggle("latest", number === state.frames);
  cell.classList.toggle("shown", number === state.shown);
  if (!isReceived) {
    cell.removeAttribute("role");
    cell.removeAttribute("title");
    delete cell.dataset.number;
    delete cell.dataset.state;
    return;
  }
  cell.id = `frame-${number}`;
  cell.dataset.number = number;
  cell.role = "option";
  cell.ariaSelected = String(number === state.shown);
  const time = timeText(state.times_s[number - 1], state.labels[number - 1]);
  const info = state.frames_info?.[number - 1];
  cell.dataset.state = info?.state ?? "todo";
  cell.classList.toggle("edited", Boolean(info?.edited));
  const review = cell.dataset.state === "todo" ? [] : [STATES[cell.dataset.state]];
  const words = [`Frame ${number}`, time, ...review, ...(info?.edited ? ["edited"] : [])];
  cell.title = words.join(", ");
  cell.ariaLabel = cell.title;
}

function reelText(state) {
  if (state.shown === null) return "No frame yet";
  const hull = `hull of ${views(state.hull.views)} so far`;
  if (state.following) return `Showing the latest, frame ${state.shown}; ${hull}`;
  return `Showing frame ${state.shown}; ${hull}`;
}

function speedText(hertz) {
  if (hertz === null) return "as computed";
  return hertz === 1 ? "1 frame/s" : `${hertz} frames/s`;
}

function speedKey(hertz) {
  return hertz === null ? AS_FAST_AS_COMPUTED : String(hertz);
}

function speedOf(key) {
  return key === AS_FAST_AS_COMPUTED ? null : Number(key);
}
