// What the lines and hatches over the picture mean, and how large the differences are.

import { fixed, withUnit } from "./numbers.js";

export class LayerLegend {
  #place;
  #entries = [];
  #seen = "";

  constructor(place) {
    this.#place = place;
  }

  /** What is on show, each [kind of hatch or colour, text]. */
  entries() {
    return this.#entries;
  }

  show({ frame, session, proposal, reprojection, wantsHull, wantsGhost, wantsShadow }) {
    const isKnown = frame && reprojection && !proposal && isCurrent(session, reprojection);
    const known = isKnown ? reprojection : null;
    const area = (px) => (known ? ` ${areaText(px, frame)}` : "");
    this.#entries = [
      ...(wantsHull ? [
        ["onlyOutline", `outline only${area(known?.only_outline_px)}`],
        ["onlyHull", `hull only${area(known?.only_hull_px)}`],
      ] : []),
      ...(wantsShadow ? [["shadow", "shadow"]] : []),
      ...(wantsGhost ? [["#b9c4d6", "neighbour"]] : []),
      ...(frame?.others ?? []).map(({ component, colour }) => [colour, component]),
    ];
    const text = JSON.stringify(this.#entries);
    if (text === this.#seen) return;
    this.#seen = text;
    this.#place.hidden = this.#entries.length === 0;
    this.#place.replaceChildren(...this.#entries.map(([kind, words]) => {
      const row = document.createElement("li");
      const swatch = document.createElement("i");
      swatch.className = `swatch ${CLASSES[kind] ?? "other-line"}`;
      if (!(kind in CLASSES)) swatch.style.borderColor = kind;
      row.append(swatch, words);
      return row;
    }));
  }
}

const CLASSES = {
  onlyOutline: "only-outline",
  onlyHull: "only-hull",
  shadow: "in-shadow",
  "#b9c4d6": "ghost-line",
};

/** Whether the areas belong to the outline as it stands on the page, and not to one before it. */
function isCurrent({ frame, isBusy, isSaving }, { outline_revision: revision }) {
  return !isBusy && !isSaving && revision === frame.silhouette.revision;
}

function areaText(px, { row_spacing_m: row, column_spacing_m: column }) {
  if (row === null) return `${fixed(px, 0)}\u202fpx²`;
  return withUnit(px * row * column, 1, "m²");
}
