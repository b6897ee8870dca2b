// How the hull is carved, which hull is on show, and what to do where nothing is left of it.

import { fixed } from "./numbers.js";

export class Carving {
  #parts;
  #hooks;
  #carving = null;

  /** `hooks.set(changes)` gives a promise, `hooks.exclude(numbers)`, `hooks.go(number)`. */
  constructor(parts, hooks) {
    this.#parts = parts;
    this.#hooks = hooks;
    const { rule, misses, spacing, side, first, last } = parts;
    parts.title.addEventListener("click", () => {
      parts.form.scrollIntoView({ block: "nearest" });
      rule.focus({ preventScroll: true });
    });
    const listen = (field, changes) => field.addEventListener("change", () => {
      if (isValid(field)) this.#set(changes());
    });
    listen(rule, () => ({ rule: rule.value }));
    listen(misses, () => ({ tolerated_misses: Number(misses.value) }));
    listen(spacing, () => ({ spacing_m: Number(spacing.value) / 100 }));
    listen(side, () => ({ side_m: Number(side.value) }));
    const range = () => ({ frame_range: [Number(first.value), Number(last.value) || null] });
    listen(first, range);
    listen(last, range);
  }

  update({ carving, hull }) {
    const { form, preview, threshold, revision, hullRevision } = this.#parts;
    form.hidden = !carving;
    this.#parts.title.hidden = !carving;
    this.#carving = carving ?? null;
    if (carving) this.#fill(fill);
    preview.hidden = !hull?.is_preview;
    // A preview is not kept: what is saved stays at the revision that it had.
    const text = hull?.revision === undefined ? "" : `rev ${hull.revision}`;
    if (!hull?.is_preview) revision.textContent = text;
    hullRevision.textContent = hull?.is_preview ? "" : text;
    threshold.textContent = hull?.threshold === undefined ? "" : thresholdText(hull);
    this.#updateEmptied(hull);
  }

  /** Ask the server; what it refuses is said here, and the fields go back to what holds. */
  async #set(changes) {
    const { complaint } = this.#parts;
    try {
      complaint.hidden = true;
      await this.#hooks.set(changes);
    } catch (error) {
      complaint.textContent = error.message;
      complaint.hidden = false;
      this.#fill((field, value) => {
        field.value = value;
      });
    }
  }

  #fill(put) {
    const { rule, misses, spacing, side, first, last } = this.#parts;
    const { frame_range: [from, to] = [1, null], ...carving } = this.#carving;
    put(rule, carving.rule);
    put(misses, String(carving.tolerated_misses));
    put(spacing, String(Number((100 * carving.spacing_m).toFixed(2))));
    put(side, String(Number(carving.side_m.toFixed(2))));
    put(first, String(from));
    put(last, to === null ? "" : String(to));
  }

  #updateEmptied(hull) {
    const { emptied } = this.#parts;
    const numbers = hull?.is_empty ? (hull.emptied_by ?? []) : [];
    emptied.hidden = numbers.length === 0;
    if (emptied.dataset.numbers === String(numbers)) return;
    emptied.dataset.numbers = String(numbers);
    if (numbers.length === 0) return;
    const text = document.createElement("p");
    text.append(
      numbers.length === 1
        ? "Without this frame there would be a hull: "
        : "Without any one of these frames there would be a hull: ",
      ...numbers.flatMap((number, index) => [index ? ", " : "", this.#frameLink(number)]),
      ".",
    );
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = numbers.length === 1 ? `Exclude frame ${numbers[0]}` : `Exclude these ${numbers.length} frames`;
    button.addEventListener("click", () => this.#hooks.exclude(numbers));
    emptied.replaceChildren(text, button);
  }

  #frameLink(number) {
    const link = document.createElement("button");
    link.type = "button";
    link.className = "link-like";
    link.textContent = String(number);
    link.ariaLabel = `Show frame ${number}`;
    link.addEventListener("click", () => this.#hooks.go(number));
    return link;
  }
}

/** "in all 15 views", "in 14 of 15 views". */
function thresholdText({ threshold, views }) {
  if (views === 0) return "";
  if (threshold >= views) return views === 1 ? "inside the 1 view" : `inside all ${fixed(views, 0)} views`;
  return `inside at least ${fixed(threshold, 0)} of ${fixed(views, 0)} views`;
}

/** Show a value unless somebody is changing it. */
function fill(field, value) {
  if (document.activeElement !== field || field.matches("select")) field.value = value;
}

/** A field holds what it may; if not, the browser says what. */
function isValid(field) {
  return field.reportValidity() && (field.value !== "" || !field.required);
}
