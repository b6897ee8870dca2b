// What is plotted over a pass: names, units, colours that the colour-blind tell apart, and ranges.

import { roundSteps } from "./numbers.js";

// Okabe and Ito's palette; of the two curves in one plot the second is dashed.
const BLUE = "#56b4e9";
const ORANGE = "#e69f00";
const PURPLE = "#cc79a7";
const YELLOW = "#f0e442";

const DASH = [5, 3];

const azimuth = {
  key: "azimuth_deg", name: "Azimuth", unit: "°", decimals: 1, colour: BLUE,
  range: [0, 360], ticks: [0, 180, 360], turn: 360,
};
const elevation = {
  key: "elevation_deg", name: "Elevation", unit: "°", decimals: 1, colour: ORANGE, dash: DASH,
  range: [0, 90], ticks: [0, 45, 90],
};
const phi = {
  ...azimuth, key: "phi_deg", name: "φ, target frame", range: [-180, 180], ticks: [-180, 0, 180],
};
const theta = {
  ...elevation, key: "theta_deg", name: "θ, target frame", range: [-90, 90], ticks: [-90, 0, 90],
};
const rotation = {
  key: "rotation_rate_deg_s", name: "Rotation rate", unit: "°/s", decimals: 2, colour: PURPLE,
};
const resolution = {
  key: "resolution_m", name: "Resolution", unit: "m", decimals: 2, colour: YELLOW, dash: DASH,
};

/** The plots of passes, one above the other, each of two quantities: left and right axis. */
export function plotted(passes) {
  const hasStation = passes.every((pass) => pass.azimuth_deg && pass.elevation_deg);
  const rows = [hasStation ? [azimuth, elevation] : [phi, theta], [rotation, resolution]];
  return rows
    .map((row) => row.filter((quantity) => passes.some((pass) => holdsAny(pass, quantity))))
    .filter((row) => row.length > 0)
    .map((row) => row.map((quantity) => (quantity.range ? quantity : { ...quantity, ...scaled(quantity, passes) })));
}

/** A pass's values; where an angle jumps by a turn the curve is interrupted. */
export function values(pass, { key, turn }) {
  const all = pass[key] ?? pass.time_s.map(() => null);
  if (turn === undefined) return all;
  const jumps = all.map((value, index) => Math.abs(value - all[index - 1]) > turn / 2);
  // Samples lie closer than pixels; the stroke across a gap of one would show.
  const margin = Math.ceil(all.length / 130);
  return all.map((value, index) => {
    const isNear = jumps.slice(Math.max(index - margin + 1, 0), index + margin + 1).some(Boolean);
    return isNear ? null : value;
  });
}

/** A pass's value at a time: that of the nearest sample. */
export function valueAt(pass, { key }, time) {
  if (!pass[key]) return null;
  let nearest = 0;
  pass.time_s.forEach((each, index) => {
    if (Math.abs(each - time) < Math.abs(pass.time_s[nearest] - time)) nearest = index;
  });
  return pass[key][nearest];
}

function holdsAny(pass, { key }) {
  return Boolean(pass[key]?.some((value) => value !== null));
}

function scaled({ key }, passes) {
  const most = Math.max(...passes.flatMap((pass) => pass[key] ?? []));
  const range = [0, most > 0 ? 1.12 * most : 1];
  const steps = roundSteps(0, range[1], 3);
  return { range, ticks: steps.map((step) => step.value), texts: steps.map((step) => step.text) };
}
