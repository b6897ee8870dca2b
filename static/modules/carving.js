// How the hull is carved, which hull is on show, and what to do where nothing is left of it.

import { fixed } from "./numbers.js";

export class Carving {
  #parts;
  #hooks;

  /** `hooks.set(changes)`, `hooks.exclude(numbers)`, `hooks.go(number)`. */
  constructor(parts, hooks) {
    this.#parts = parts;
    this.#hooks = hooks;
    const { rule, misses, spacing } = parts;
    rule.addEventListener("change", () => hooks.set({ rule: rule.value }));
    misses.addEventListener("change", () => {
      if (isValid(misses)) hooks.set({ tolerated_misses: Number(misses.value) });
    });
    spacing.addEventListener("change", () => {
      if (isValid(spacing)) hooks.set({ spacing_m: Number(spacing.value) / 100 });
    });
  }

  update({ carving, hull }) {
    const { form, rule, misses, spacing, preview, threshold, revision } = this.#parts;
    form.hidden = !carving;
    if (carving) {
      fill(rule, carving.rule);
      fill(misses, String(carving.tolerated_misses));
      fill(spacing, String(Number((100 * carving.spacing_m).toFixed(2))));
    }
    preview.hidden = !hull?.is_preview;
    revision.textContent = hull?.revision === undefined ? "" : `rev ${hull.revision}`;
    threshold.textContent = hull?.threshold === undefined ? "" : thresholdText(hull);
    this.#updateEmptied(hull);
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
  return field.reportValidity() && field.value !== "";
}
