// What is known of the frame and of the hull, in words and numbers.

import { leastSeen, nearestAxis } from "./directions.js";
import { endsText } from "./measurement-text.js";
import { count, fixed, frames, keptTogether, timeText, vector, withUnit } from "./numbers.js";

/** The rows that describe a frame. */
export function frameRows(frame) {
  return [
    ["Time", timeText(frame.time_s, frame.label)],
    ["Line of sight", frame.line_of_sight.map((part, axis) => `${"xyz"[axis]}\u00a0${fixed(part, 2)}`).join(", ")],
    ["θ, φ", `${fixed(frame.theta_deg, 1)}°, ${fixed(frame.phi_deg, 1)}° in the target frame`],
    [
      "Resolution",
      frame.row_resolution_m === null
        ? "unknown"
        : `${withUnit(frame.row_resolution_m, 2, "m")} in range, ` +
          `${withUnit(frame.column_resolution_m, 2, "m")} in cross-range`,
    ],
    ["Interval", intervalText(frame.interval)],
    ["Silhouette", silhouetteText(frame)],
    ["Found by", frame.silhouette.provenance || "unknown"],
    ["Repaired", [frame.silhouette.repair, frame.silhouette.vote_repair].filter(Boolean).join(" ")],
  ].filter(([, text]) => text);
}

/** "accepted, 3.1°, 14.2 s, 512 pulses", or what is wrong with it in words; empty where unknown. */
function intervalText(interval) {
  if (!interval) return "";
  const { verdict, in_words: words, start_s: start, stop_s: stop, turn_deg: turn, pulses } = interval;
  const size = [
    isGiven(turn) && `${fixed(turn, 1)}°`,
    isGiven(start) && isGiven(stop) && withUnit(stop - start, 1, "s"),
    isGiven(pulses) && `${count(pulses)} pulses`,
  ].filter(Boolean).join(", ");
  if (!words) return [verdict, size].filter(Boolean).join(", ");
  return `${size}. ${keptTogether(words)}`;
}

const isGiven = (value) => value !== null && value !== undefined;

function silhouetteText(frame) {
  const { rings, claim, area_px: area } = frame.silhouette;
  if (rings.length === 0) return "nothing found";
  const side = claim === "lit side" ? "lit side only" : "complete";
  if (frame.row_spacing_m === null) return `${side}, ${count(Math.round(area))} px`;
  const square = area * frame.row_spacing_m * frame.column_spacing_m;
  return `${side}, ${withUnit(square, 1, "m²")}`;
}

/** The rows that describe the hull's surface, how lightly it is drawn, and how soon it followed. */
export function hullRows(hull, light, latencyMs, interval) {
  const ends = interval ? ` ${endsText(...interval, "m³")}` : "";
  const rows = [
    ["Volume", hull.volume_m3 === null ? "not bounded" : `${withUnit(hull.volume_m3, 1, "m³")}${ends}`],
    ["Vertices", count(hull.vertices)],
    ["Faces", count(hull.faces)],
  ];
  if (latencyMs !== null) rows.push(["Followed the last edit in", durationText(latencyMs)]);
  if (light === null) return rows;
  const off = withUnit(1000 * light.error_m, 1, "mm");
  return [...rows, ["Drawn with", `${count(light.faces)} faces, ${off} off at most`]];
}

function durationText(ms) {
  return ms < 1000 ? withUnit(ms, 0, "ms") : withUnit(ms / 1000, 1, "s");
}

/** Replace the rows of a description list. */
export function showRows(list, rows) {
  list.replaceChildren(
    ...rows.map(([term, text]) => {
      const row = document.createElement("div");
      row.append(element("dt", term), element("dd", text));
      return row;
    }),
  );
}

/**
 * Replace the rows of the extents' table; what is not bounded gets words, never a number.
 * `intervals` are pairs of ends, in the same order; empty where there are none.
 */
export function showExtents(body, extents, intervals = []) {
  body.replaceChildren(
    ...extents.map((extent, index) => {
      const row = document.createElement("tr");
      const name = element("th", extent.name);
      name.scope = "row";
      const swatch = element("i", "");
      swatch.className = `swatch ${extent.name[0]}`;
      name.prepend(swatch);
      if (extent.is_bounded) name.append(gradeMark(extent));
      row.append(name, extentCell(extent, intervals[index]));
      return row;
    }),
  );
}

function extentCell(extent, interval) {
  if (!extent.is_bounded) {
    return openCell("not bounded", "The views do not close the hull along this axis, so there is no length to give");
  }
  return lengthCell(extent.value_m, interval);
}

function openCell(words, title = "") {
  const cell = element("td", words);
  cell.title = title;
  cell.className = "open";
  return cell;
}

function lengthCell(length, interval) {
  const cell = element("td", fixed(length, 2));
  cell.append(element("small", "\u202fm"));
  if (interval?.[0] === null || interval === undefined) return cell;
  const ends = element("span", endsText(...interval, "m"));
  ends.className = "interval";
  ends.title = "95 % interval";
  cell.append(ends);
  return cell;
}

/** " weakly constrained" behind what the views constrain only so. */
function gradeMark({ observability }) {
  const mark = element("span", observability === "weak" ? " weakly constrained" : "");
  mark.className = "grade";
  return mark;
}

/** Replace the rows of the principal lines' table: length and unit vector of each. */
export function showLines(body, lines, intervals = []) {
  body.replaceChildren(
    ...lines.map((line, index) => {
      const row = document.createElement("tr");
      const name = element("th", line.name);
      name.scope = "row";
      name.append(gradeMark(line), element("small", vector(line.direction)));
      const length = line.length_m === null
        ? openCell("not observed by these views")
        : lengthCell(line.length_m, intervals[index]);
      row.append(name, length);
      return row;
    }),
  );
}

/** Show what a person should know of a frame, as a sentence; nothing where there is nothing. */
export function showNote(place, note) {
  place.hidden = note === "";
  place.textContent = note && `${note[0].toUpperCase()}${note.slice(1)}.`;
}

/** Name the direction that lacks views, where the hull is open. */
export function showUnobserved(note, hull, { blind = [], frames_info: infos = [] }) {
  const isOpen = hull.extents.some((extent) => !extent.is_bounded);
  note.hidden = hull.unobserved === null && !isOpen;
  if (note.hidden) return;
  if (hull.unobserved !== null) {
    note.replaceChildren(
      element("b", `No view constrains the direction ${named(hull.unobserved)}.`),
      "All lines of sight so far turn in nearly one plane; along this direction (x, y, z) the " +
        "hull is not measured.",
    );
    return;
  }
  const worst = leastSeen(blind.filter((_, index) => infos[index]?.votes));
  note.replaceChildren(
    element("b", "The hull reaches the side of the grid: the views do not close it."),
    worst === null ? "" : `Views lack most along ${named(worst.direction)}, ` +
      `${fixed(worst.degrees, 0)}° from the nearest image plane.`,
  );
}

/** "0.02, −0.98, 0.21 (nearly y cross-track)". */
function named(direction) {
  return `${vector(direction)} (${nearestAxis(direction)})`;
}

/** "after 12 frames". */
export function afterFrames(number) {
  return `after ${frames(number)}`;
}

function element(name, text) {
  const made = document.createElement(name);
  made.textContent = text;
  return made;
}
