// How a measurement reads: its number, interval and change, and the words that stand for none.

import { fixed, vector, withUnit } from "./numbers.js";

const DECIMALS = { m: 2, "m²": 2, "m³": 1, rad: 1, "": 3 };
const LEAST_DECIMALS = { m: 1, "m²": 1, "m³": 0, rad: 1, "": 2 };
const DEGREES = 180 / Math.PI;

/** A number in the unit that people read: angles in degrees. */
function shown(value, unit) {
  return unit === "rad" ? value * DEGREES : value;
}

/** "28.63 m", "41.2°", "0.612". */
export function valueText(value, unit) {
  const text = shown(value, unit);
  if (unit === "rad") return `${fixed(text, DECIMALS.rad)}°`;
  return unit === "" ? fixed(text, DECIMALS[""]) : withUnit(text, DECIMALS[unit], unit);
}

/** "[28.1, 29.0]", no finer than it is wide; empty where there is none. */
export function endsText(low, high, unit) {
  if (low === null || high === null || low === undefined) return "";
  const ends = [shown(low, unit), shown(high, unit)];
  const wide = Math.max(ends[1] - ends[0], 1e-6);
  const fitting = Math.ceil(-Math.log10(wide / 8));
  const decimals = Math.min(Math.max(LEAST_DECIMALS[unit], fitting), DECIMALS[unit] + 1);
  return `[${ends.map((end) => fixed(end, decimals)).join(", ")}]`;
}

/** "−0.12", "+0.03", "±0.00"; empty where nothing is known of it. */
export function changeText(change, unit) {
  if (change === null) return "";
  const decimals = DECIMALS[unit];
  const text = fixed(shown(change, unit), decimals);
  if (Number(text.replace("−", "-")) === 0) return `±${fixed(0, decimals)}`;
  return text.startsWith("−") ? text : `+${text}`;
}

/** What stands in the number's place where there is none. */
export function missingText({ lost, observability, revision }) {
  if (lost !== null) return "lost";
  if (revision === null) return "measuring…";
  return observability === "unobserved" ? "not observed" : "–";
}

/** Why a row has no number, as a sentence; empty where it has one. */
export function reasonText({ lost, observability }) {
  if (lost !== null) return lost;
  if (observability !== "unobserved") return "";
  return "These views do not constrain it: what the hull shows there is the grid's, or a guess.";
}

/** The rows of a measurement's details. */
export function detailRows(item, frame) {
  const { kind, direction, unit } = item;
  return [
    ["Kind", kind],
    [`Vector, ${frame}`, direction && vectorText(item, frame)],
    ["Angles to x, y, z", item.angles_deg?.map((angle) => `${fixed(angle, 1)}°`).join(", ")],
    ["Sizes", kind !== "length" && item.sizes_m.length > 1 && sizesText(item.sizes_m)],
    ["Residual", item.residual_m !== null && withUnit(1000 * item.residual_m, 0, "mm rms")],
    ["Views", { good: "constrain it well", weak: "constrain it weakly" }[item.observability]],
    ["Interval", item.low !== null && item.interval_note],
    ["No interval", item.low === null && item.interval_note],
    ["Before", oldText(item.old_interval, unit)],
    ["Belongs to", stampText(item)],
  ].filter(([, text]) => text);
}

function vectorText(item, frame) {
  const found = { target: item.direction, RTN: item.rtn, TEME: item.teme }[frame];
  if (!found) return "not known in this frame";
  const epoch = frame === "TEME" ? ` at ${item.epoch_utc.replace("T", " ").replace(/(\.\d)?\d*Z$/, "$1 UTC")}` : "";
  return `${found.map((part) => fixed(part, 3)).join(", ")}${epoch}${item.is_undirected ? ", undirected" : ""}`;
}

function sizesText(sizes) {
  return `${sizes.map((size) => fixed(size, 2)).join(" × ")}\u202fm`;
}

function oldText(old, unit) {
  if (!old) return "";
  const { value, low, high, revision } = old;
  return `${valueText(value, unit || "")} ${endsText(low, high, unit || "")} at revision ${revision}`;
}

function stampText({ revision, threshold }) {
  return revision === null ? "" : `hull revision ${revision}, ≥ ${threshold} votes`;
}

/** A vector as the collapsed row has it. */
export function shortVector(item, frame) {
  const found = { target: item.direction, RTN: item.rtn, TEME: item.teme }[frame];
  return found ? vector(found) : "";
}
