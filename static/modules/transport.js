// Play, pause, step, speed, restart, the row of frames, and the keys for them.

import { Cells } from "./cells.js";
import { views } from "./numbers.js";

const AS_FAST_AS_COMPUTED = "max";
const TAP_MS = 500;

export class Transport {
  #state = null;
  #send;
  #show;
  #parts;
  #cells;

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
    this.#cells = new Cells(parts.cells, show);
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
    this.#cells.update(state);
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

  #updateSpeeds(state) {
    const { speed } = this.#parts;
    const offered = [...new Set([...state.speeds_hz, state.speed_hz])];
    if (speed.options.length !== offered.length) {
      speed.replaceChildren(...offered.map((hertz) => new Option(speedText(hertz), speedKey(hertz))));
    }
    speed.value = speedKey(state.speed_hz);
  }
}

function reelText(state) {
  if (state.shown === null) return "No frame yet";
  const hull = `hull of ${views(state.hull.views)}${state.status === "finished" ? "" : " so far"}`;
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
