// Measuring by clicks on the hull: what is being picked, and what a click snaps to.

import { part } from "./elements.js";
import { openUnder } from "./menus.js";
import { send } from "./server.js";

export class Picking {
  /** As the server tells it, null where this page picks nothing. */
  #now = null;
  #kind = "length";
  #snap = "surface";
  #name;
  #path;
  #complain;

  /** Pick in a SpaceView's view, and call `complain(sentence)` for what is refused. */
  constructor(space, complain) {
    this.#path = `/api/viewport/${space.name}/picking`;
    this.#name = space.name;
    this.#complain = complain;
    openUnder(part("measure-menu"), part("measure-button"));
    for (const button of this.#kindButtons()) {
      button.addEventListener("click", () => {
        part("measure-menu").hidePopover();
        this.#kind = button.dataset.measure;
        this.#begin();
      });
    }
    for (const button of this.#snapButtons()) {
      button.addEventListener("click", () => {
        this.#snap = button.dataset.snap;
        this.#begin();
      });
    }
    part("pick-stop").addEventListener("click", () => this.stop());
  }

  update(state) {
    this.#now = state.picking?.[this.#name] ?? null;
    const bar = part("pick-bar");
    bar.hidden = this.#now === null;
    part("pick-chip").hidden = this.#now === null;
    part("measure-button").disabled = state.hull === null || state.hull.is_empty;
    part("measure-button").setAttribute("aria-pressed", String(this.#now !== null));
    for (const button of this.#kindButtons()) {
      button.setAttribute("aria-current", String(button.dataset.measure === this.#now?.kind));
    }
    if (this.#now === null) return;
    const { kind, snap, complaint, hint, picked, snaps } = this.#now;
    Object.assign(bar.dataset, { kind, snap, picked });
    part("pick-hint").textContent = `${hint} – Esc cancels`;
    part("pick-complaint").hidden = complaint === "";
    part("pick-complaint").textContent = complaint;
    part("pick-snaps").hidden = !snaps;
    for (const button of this.#snapButtons()) button.ariaPressed = String(button.dataset.snap === snap);
  }

  /** Begin to measure what was measured last, or stop. */
  toggle() {
    if (!this.stop()) this.#begin();
  }

  /** Stop picking, if this page does; tells whether it did. */
  stop() {
    return this.#ask("DELETE", "");
  }

  /** End a polyline. */
  finish() {
    return this.#now?.kind === "polyline" && this.#ask("POST", "/end");
  }

  /** Forget the last pick. */
  takeBack() {
    return this.#now?.picked > 0 && this.#ask("DELETE", "/picks/last");
  }

  /** Act on a key pressed in the view in space; tells whether it was one of ours. */
  onKeyInSpace(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || event.repeat) return false;
    if (event.key === "m" || event.key === "M") this.toggle();
    else if (event.key === "Escape") return this.stop();
    else if (event.key === "Enter") return this.finish();
    else if (event.key === "Backspace" || event.key === "Delete") return this.takeBack();
    else return false;
    return true;
  }

  #begin() {
    if (part("measure-button").disabled) return;
    send("PUT", this.#path, { kind: this.#kind, snap: this.#snap })
      .catch((error) => this.#complain(error.message));
  }

  #ask(method, where) {
    if (this.#now === null) return false;
    send(method, `${this.#path}${where}`).catch((error) => this.#complain(error.message));
    return true;
  }

  #kindButtons() {
    return part("measure-menu").querySelectorAll("button");
  }

  #snapButtons() {
    return part("pick-snaps").querySelectorAll("button");
  }
}
