// How the hull agrees with the reference mesh: asked for, stamped, and coloured in space.

import { part } from "./elements.js";
import { openUnder } from "./menus.js";
import { fixed, withUnit } from "./numbers.js";
import { send } from "./server.js";

export class ReferenceView {
  #space;
  #seen = "";
  #isColoured = false;

  /** Show it beside a SpaceView, and call `complain(sentence)` for what is refused. */
  constructor(space, complain) {
    this.#space = space;
    space.onLayers = () => this.#showLegend();
    openUnder(part("compare-menu"), part("compare-button"));
    part("compare-run").addEventListener("click", () => {
      send("POST", "/api/reference/comparison")
        .then(() => space.showLayer("distance", true))
        .catch((error) => complain(error.message));
    });
  }

  update({ reference, hull }) {
    part("compare-button").hidden = !reference;
    if (!reference) return;
    const { comparison, is_running: isRunning, complaint } = reference;
    const isStale = comparison !== null && comparison.revision !== hull?.revision;
    part("compare-run").disabled = isRunning || !hull || hull.is_empty;
    part("compare-run").textContent = isRunning ? "Comparing…" : "Compare with reference";
    part("compare-note").textContent = complaint;
    part("compare-note").hidden = complaint === "";
    this.#isColoured = reference.is_coloured;
    this.#showLegend();
    const text = JSON.stringify([comparison, isStale]);
    if (text === this.#seen) return;
    this.#seen = text;
    part("compare-facts").classList.toggle("stale", isStale);
    part("compare-stamp").textContent = stamp(comparison, isStale);
    part("compare-facts").replaceChildren(...(comparison ? rows(comparison) : []).map(row));
    if (comparison) scaleLegend(comparison);
  }

  #showLegend() {
    const isShown = this.#isColoured && this.#space.layers.includes("distance");
    part("distance-legend").hidden = !isShown;
  }
}

function stamp(comparison, isStale) {
  if (comparison === null) return "not compared yet";
  return `revision ${comparison.revision}${isStale ? ", an earlier hull" : ""}`;
}

function rows(found) {
  return [
    ["Intersection over union", withUnit(100 * found.intersection_over_union, 1, "%"), "Of the enclosed voxels"],
    ["Chamfer distance", withUnit(found.chamfer_m, 3, "m"), "Mean distance from surface to surface, mean of both ways"],
    ["Hausdorff distance", withUnit(found.hausdorff_m, 3, "m"), "Greatest distance found, either way"],
    ["Signed distance, mean", withUnit(found.mean_m, 3, "m"), "Over the hull's area, outside the reference positive"],
    ["rms", withUnit(found.rms_m, 3, "m"), "Over the hull's area"],
    ["farthest outside", withUnit(found.outside_m, 3, "m"), "Of the hull's vertices"],
    ["deepest inside", withUnit(found.inside_m, 3, "m"), "Of the hull's vertices"],
  ];
}

function row([name, value, hint]) {
  const term = document.createElement("dt");
  const text = document.createElement("dd");
  term.textContent = name;
  term.title = hint;
  text.textContent = value;
  const pair = document.createElement("div");
  pair.append(term, text);
  return pair;
}

function scaleLegend({ limit_m: limit, colours }) {
  const legend = part("distance-legend");
  legend.querySelector("i").style.background = `linear-gradient(90deg, ${colours.join(", ")})`;
  part("distance-low").value = `−${fixed(limit, 2)}`;
  part("distance-high").value = `+${fixed(limit, 2)}`;
}
