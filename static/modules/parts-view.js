// The target's parts that have hulls of their own: their lengths, and where they are in the whole.

import { part } from "./elements.js";
import { showExtents, showLines, showRows } from "./facts-view.js";
import { fixed, vector, views, withUnit } from "./numbers.js";

let seen = "";

/** Show each part's numbers under a heading in its colour. */
export function showParts({ components = [] }) {
  const text = JSON.stringify(components);
  if (text === seen) return;
  seen = text;
  part("parts").hidden = components.length === 0;
  part("parts").replaceChildren(...components.map(partSection));
}

function partSection({ label, colour, hull, place, has_place: hasPlace }) {
  const section = document.createElement("section");
  section.className = "part-facts";
  section.dataset.part = label;
  section.dataset.revision = hull.revision;
  section.append(heading(label, colour, hull));
  if (hull.is_empty) section.append(hint(emptyText(hull)));
  else section.append(...numbers(hull, place, hasPlace), ...(hull.is_preview ? [] : [downloads(label)]));
  return section;
}

function heading(label, colour, hull) {
  const title = document.createElement("h3");
  const swatch = document.createElement("i");
  swatch.className = "swatch";
  swatch.style.background = colour;
  const stamp = document.createElement("small");
  stamp.textContent = `${views(hull.views)}, rev ${hull.revision}${hull.is_preview ? ", preview" : ""}`;
  title.append(swatch, label, stamp);
  return title;
}

function numbers(hull, place, hasPlace) {
  const lines = table("extents lines");
  showLines(lines.tBodies[0], hull.lines);
  const extents = table("extents");
  showExtents(extents.tBodies[0], hull.extents);
  const rows = document.createElement("dl");
  rows.className = "facts";
  showRows(rows, [
    ["Volume", hull.volume_m3 === null ? "not bounded" : withUnit(hull.volume_m3, 2, "m³")],
    ...(place ? placeRows(place) : []),
  ]);
  const missing = hint(placelessText(hull, hasPlace));
  return [...(hull.lines.length > 0 ? [lines] : []), extents, rows, ...(place ? [] : [missing])];
}

function downloads(label) {
  const line = hint("Hull as ");
  ["GLB", "PLY", "STL"].forEach((name, index) => {
    const link = Object.assign(document.createElement("a"), { textContent: name, download: "" });
    link.href = `/api/export/hull.${name.toLowerCase()}?component=${encodeURIComponent(label)}`;
    line.append(index === 0 ? "" : ", ", link);
  });
  return line;
}

function placeRows({ offset_m: offset, turn_deg: turn, volume_share: share }) {
  return [
    ["Centre from the whole's", withUnit(Math.hypot(...offset), 2, "m")],
    ["along x, y, z", `${vector(offset)}\u202fm`],
    ["Axes turned from the whole's", `${fixed(turn, 1)}°`],
    ["Of the whole's volume", `${fixed(100 * share, 1)}\u202f%`],
  ];
}

function placelessText({ is_preview: isPreview }, hasPlace) {
  if (isPreview) return "Its place in the whole is told once the outline is kept.";
  if (hasPlace) return "Its place in the whole comes once nothing has changed for three seconds.";
  return "Its place in the whole is told once the views bound every extent of both.";
}

function emptyText({ views: voting }) {
  if (voting === 0) return "There is no hull: no frame that outlines it votes.";
  return "Its hull is empty: no point lies inside every outline of it.";
}

function table(names) {
  const made = document.createElement("table");
  made.className = names;
  made.createTBody();
  return made;
}

function hint(text) {
  return Object.assign(document.createElement("p"), { className: "hint", textContent: text });
}
