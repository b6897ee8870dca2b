// How far each frame's outline has been reviewed, and going from frame to frame.

export const STATES = { todo: "to do", ok: "OK", fix: "to fix", excluded: "excluded" };

export class Review {
  #parts;
  #state = null;
  #send;
  #show;

  /** Set states through `send(number, state)` and go to frames through `show(number or null)`. */
  constructor(parts, send, show) {
    this.#parts = parts;
    this.#send = send;
    this.#show = show;
    for (const button of parts.buttons) {
      button.addEventListener("click", () => this.set(button.dataset.state));
    }
    parts.accept.addEventListener("click", () => this.accept());
  }

  update(state) {
    this.#state = state;
    const shown = this.#shown();
    for (const button of this.#parts.buttons) {
      button.disabled = shown === undefined;
      button.ariaPressed = String(button.dataset.state === shown?.state);
    }
    this.#parts.accept.disabled = shown === undefined;
    const infos = state.frames_info ?? [];
    const done = infos.filter((info) => info.state !== "todo" && info.state !== "fix").length;
    this.#parts.count.textContent = infos.length === 0 ? "" : `${done} of ${infos.length} reviewed`;
  }

  set(name) {
    if (this.#shown()) this.#send(this.#shown().number, name);
  }

  /** Call the frame on show ok and go to the next one that waits for review. */
  async accept() {
    const shown = this.#shown();
    if (!shown) return;
    await this.#send(shown.number, "ok");
    const infos = this.#state.frames_info;
    const inTurn = [...infos.slice(shown.number), ...infos.slice(0, shown.number - 1)];
    const next = inTurn.find((info) => info.state === "todo");
    if (next) this.#show(next.number);
  }

  /** Go back or on by so many frames, among those received. */
  leaf(by) {
    const { shown, frames } = this.#state ?? {};
    if (!shown) return;
    const number = Math.min(Math.max(shown + by, 1), frames);
    if (number !== shown) this.#show(number);
  }

  #shown() {
    return this.#state?.frames_info?.find((info) => info.number === this.#state.shown);
  }
}
