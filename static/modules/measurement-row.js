// One measurement in the book's list: a line, and details under it that unfold.

import {
  changeText,
  detailRows,
  endsText,
  missingText,
  reasonText,
  shortVector,
  valueText,
} from "./measurement-text.js";
import { showRows } from "./facts-view.js";

export class MeasurementRow {
  element = made("li", "item");
  #hooks;
  #item = null;
  #name = made("button", "item-name");
  #value = made("span", "item-value");
  #interval = made("small", "item-interval");
  #change = made("span", "item-change");
  #vector = made("small", "item-vector");
  #grade = made("small", "item-grade");
  #reason = made("p", "item-reason");
  #more = made("div", "item-more");
  #facts = made("dl", "facts");
  #note = made("input", "item-note");
  #hide = made("button", "small");
  #rename = made("button", "small");
  #input = null;

  /** `hooks.rename(name, new)`, `.note(name, text)`, `.hide(name, bool)`, `.remove(item)`, `.toggle(name)`. */
  constructor(hooks) {
    this.#hooks = hooks;
    const line = made("div", "item-line");
    const under = made("div", "item-under");
    const numbers = made("span", "item-numbers");
    const remove = made("button", "small");
    const buttons = made("div", "item-buttons");
    for (const button of [this.#name, this.#hide, this.#rename, remove]) button.type = "button";
    this.#name.addEventListener("click", () => hooks.toggle(this.#item.name));
    this.#name.addEventListener("dblclick", () => this.#edit());
    this.#name.addEventListener("keydown", (event) => event.key === "F2" && this.#edit());
    this.#rename.textContent = "Rename";
    this.#rename.addEventListener("click", () => this.#edit());
    this.#hide.addEventListener("click", () => hooks.hide(this.#item.name, !this.#item.is_hidden));
    remove.textContent = "Delete";
    remove.addEventListener("click", () => hooks.remove(this.#item));
    Object.assign(this.#note, { type: "text", placeholder: "Note", maxLength: 10000, ariaLabel: "Note" });
    this.#note.addEventListener("change", () => hooks.note(this.#item.name, this.#note.value));
    numbers.append(this.#value, " ", this.#interval);
    line.append(this.#name, numbers);
    under.append(this.#vector, this.#grade, this.#change);
    buttons.append(this.#rename, this.#hide, remove);
    this.#more.append(this.#facts, this.#note, buttons);
    this.element.append(line, under, this.#reason, this.#more);
  }

  /** Show an item; `isOld` where its number is not the hull's on show. */
  update(item, { frame, isOpen, isOld }) {
    this.#item = item;
    this.element.dataset.name = item.name;
    this.element.dataset.revision = item.revision ?? "";
    this.element.classList.toggle("stale", isOld);
    this.element.classList.toggle("hidden-item", item.is_hidden);
    if (this.#input === null) this.#name.textContent = item.name;
    this.#name.title = item.note || item.name;
    this.#name.ariaExpanded = String(isOpen);
    this.#showNumber(item);
    this.#vector.textContent = shortVector(item, frame);
    this.#grade.textContent = [item.observability === "weak" && "weakly constrained", item.is_hidden && "hidden"]
      .filter(Boolean).join(", ");
    this.#reason.textContent = reasonText(item);
    this.#reason.hidden = this.#reason.textContent === "";
    this.#more.hidden = !isOpen;
    if (isOpen) showRows(this.#facts, detailRows(item, frame));
    if (document.activeElement !== this.#note) this.#note.value = item.note;
    this.#hide.textContent = item.is_hidden ? "Show" : "Hide";
  }

  #showNumber(item) {
    const hasNumber = item.value !== null;
    this.#value.textContent = hasNumber ? valueText(item.value, item.unit) : missingText(item);
    this.#value.classList.toggle("open", !hasNumber && item.revision !== null);
    const { old_interval: old } = item;
    const isOf = item.low !== null ? item : old;
    this.#interval.textContent = hasNumber && isOf ? endsText(isOf.low, isOf.high, item.unit) : "";
    this.#interval.classList.toggle("stale", item.low === null);
    this.#interval.title = item.low !== null ? item.interval_note : old ? `of revision ${old.revision}` : "";
    this.#change.textContent = hasNumber ? changeText(item.change, item.unit) : "";
    this.#change.title = this.#change.textContent && "Change against the hull measured before";
  }

  /** Let the name be typed where it stands. */
  #edit() {
    if (this.#input !== null) return;
    const input = made("input", "item-rename");
    this.#input = input;
    Object.assign(input, { type: "text", value: this.#item.name, maxLength: 200, ariaLabel: "New name" });
    const end = (isKept) => {
      if (this.#input === null) return;
      this.#input = null;
      input.replaceWith(this.#name);
      const text = input.value.trim();
      if (isKept && text && text !== this.#item.name) this.#hooks.rename(this.#item.name, text);
      this.#name.focus();
    };
    input.addEventListener("keydown", (event) => {
      if (event.key === "Enter") end(true);
      if (event.key === "Escape") end(false);
      event.stopPropagation();
    });
    input.addEventListener("blur", () => end(true));
    this.#name.replaceWith(input);
    input.select();
    input.focus();
  }
}

function made(name, className) {
  return Object.assign(document.createElement(name), { className });
}
