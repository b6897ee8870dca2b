// Which levels the picture shows and in which colours: kept from frame to frame and over reloads.

import { part } from "./elements.js";
import { withUnit } from "./numbers.js";
import { getJson } from "./server.js";

const KEPT = "radarhull.picture";
const NARROWEST_DB = 5;
/** Of a frame's own levels: most of the background lies below the first, few peaks above the last. */
const SHARES = [0.85, 0.9995];

export class DynamicRange {
  #view;
  #levels = null;
  #colours = new Map();

  /** Control what `view` shows, beginning with what was chosen last. */
  constructor(view) {
    this.#view = view;
    part("floor").addEventListener("input", () => this.#set("floor"));
    part("top").addEventListener("input", () => this.#set("top"));
    part("range-preset").addEventListener("change", () => this.#preset());
    part("colours").addEventListener("change", () => this.chooseColours());
    this.#recall();
    this.#show();
  }

  /** Take the levels of the frame on show; its own percentiles set the range where that is asked. */
  take(levels) {
    this.#levels = levels;
    if (part("range-preset").value === "auto") this.#preset();
  }

  async chooseColours() {
    const name = part("colours").value;
    this.#keep();
    if (!this.#colours.has(name)) this.#colours.set(name, await getJson(`/api/colours?name=${name}`));
    if (part("colours").value === name) this.#view.setColours(this.#colours.get(name));
  }

  #preset() {
    const { value } = part("range-preset");
    if (value === "auto" && this.#levels) [part("floor").value, part("top").value] = ownRange(this.#levels);
    else if (Number(value)) [part("floor").value, part("top").value] = [-Number(value), 0];
    this.#show();
  }

  #set(changed) {
    const [floor, top] = [part("floor"), part("top")];
    part("range-preset").value = "own";
    if (Number(top.value) - Number(floor.value) < NARROWEST_DB) {
      if (changed === "floor") top.value = Number(floor.value) + NARROWEST_DB;
      floor.value = Math.min(Number(floor.value), Number(top.value) - NARROWEST_DB);
    }
    this.#show();
  }

  #show() {
    const [floorDb, topDb] = [Number(part("floor").value), Number(part("top").value)];
    part("floor-value").textContent = withUnit(floorDb, 0, "dB");
    part("top-value").textContent = withUnit(topDb, 0, "dB");
    this.#view.setLevels(floorDb, topDb);
    this.#keep();
  }

  #keep() {
    const chosen = ["floor", "top", "range-preset", "colours"].map((id) => [id, part(id).value]);
    localStorage.setItem(KEPT, JSON.stringify(Object.fromEntries(chosen)));
  }

  #recall() {
    let kept = {};
    try {
      kept = JSON.parse(localStorage.getItem(KEPT)) ?? {};
    } catch {
      // What is kept is not ours to trust; the page starts as it would without.
    }
    for (const id of ["floor", "top", "range-preset", "colours"]) {
      const control = part(id);
      const before = control.value;
      if (typeof kept[id] === "string") control.value = kept[id];
      if (control.value === "") control.value = before;
    }
  }
}

/** The range in whole dB between two percentiles of a frame's levels. */
export function ownRange({ numbers, floorDb, stepDb }) {
  const counts = new Uint32Array(65536);
  for (const number of numbers) counts[number] += 1;
  const [low, high] = SHARES.map((share) => {
    let left = share * numbers.length;
    return floorDb + stepDb * Math.max(counts.findIndex((count) => (left -= count) < 0), 0);
  });
  const topDb = Math.min(Math.ceil(high), 0);
  return [Math.min(Math.floor(low), topDb - NARROWEST_DB), topDb];
}
