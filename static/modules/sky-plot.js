// The sky plot: where each frame was taken from, as the station saw the target or, where no station
// is known, by the angles of the lines of sight in the target frame.

import { angles } from "./directions.js";
import { clickDots, frameDots, shape } from "./svg.js";

const RADIUS = 96;

export class SkyPlot {
  #parts;

  /** `parts.svg`, `parts.title`, `parts.caption`; `go(number)` shows a frame. */
  constructor(parts, go) {
    this.#parts = parts;
    clickDots(parts.svg, go);
  }

  update({ sights = [], labels, times_s: times, shown }, passes) {
    const { svg, title, caption } = this.#parts;
    const known = passes.filter((pass) => pass.azimuth_deg && pass.elevation_deg);
    const seen = times.map((time, index) => skyAt(known, labels[index], time));
    const isStation = seen.some(Boolean);
    const polar = isStation ? seen : sights.map(targetAngles);
    const tracks = isStation ? known.map(trackOf) : [];
    svg.replaceChildren(
      ...rings(isStation),
      ...tracks.map((points) => shape("polyline", { points, class: "track" })),
      ...frameDots(polar.map((place) => place && onSky(place)), shown, (number) =>
        polar[number - 1].isHollow ? "hollow" : ""),
    );
    title.textContent = isStation ? "Sky over the station" : "Lines of sight, θ and φ";
    caption.textContent = isStation
      ? "Azimuth and elevation, the horizon at the rim. A dot is a frame; click to show it."
      : "In the target frame, for no station is known: φ clockwise from y, θ = 0° at the rim, hollow where positive. A dot is a frame; click to show it.";
  }
}

function targetAngles(sight) {
  const [theta, phi] = angles(sight);
  return { azimuth: phi, elevation: Math.abs(theta), isHollow: theta > 0 };
}

/** The station's azimuth and elevation at a time of the pass of that name, null where unknown. */
function skyAt(passes, label, time) {
  const pass = passes.find((each) => each.label === label) ?? (passes.length === 1 ? passes[0] : null);
  if (!pass) return null;
  const { time_s: times, azimuth_deg: azimuths, elevation_deg: elevations } = pass;
  const after = times.findIndex((each) => each >= time);
  if (after === -1 || times[0] > time) return null;
  const before = Math.max(after - 1, 0);
  const span = times[after] - times[before];
  const share = span === 0 ? 0 : (time - times[before]) / span;
  const turn = ((((azimuths[after] - azimuths[before]) % 360) + 540) % 360) - 180;
  return {
    azimuth: azimuths[before] + share * turn,
    elevation: elevations[before] + share * (elevations[after] - elevations[before]),
  };
}

function trackOf({ azimuth_deg: azimuths, elevation_deg: elevations }) {
  return azimuths
    .map((azimuth, index) => ({ azimuth, elevation: elevations[index] }))
    .filter(({ elevation }) => elevation >= 0)
    .map((place) => onSky(place).map((value) => value.toFixed(1)).join(","))
    .join(" ");
}

function onSky({ azimuth, elevation }) {
  const radius = RADIUS * (1 - Math.max(elevation, 0) / 90);
  const angle = (azimuth * Math.PI) / 180;
  return [radius * Math.sin(angle), -radius * Math.cos(angle)];
}

function rings(isStation) {
  const names = isStation ? ["N", "E", "S", "W"] : ["0°", "90°", "180°", "270°"];
  const spoke = (x, y) => shape("line", { x1: -x, y1: -y, x2: x, y2: y, class: "ring" });
  const places = [[0, -RADIUS - 6, "middle"], [RADIUS + 4, 4, "start"], [0, RADIUS + 15, "middle"], [-RADIUS - 4, 4, "end"]];
  return [
    ...[1, 2 / 3, 1 / 3].map((share) => shape("circle", { r: RADIUS * share, class: "ring" })),
    spoke(RADIUS, 0),
    spoke(0, RADIUS),
    ...names.map((name, index) => {
      const [x, y, anchor] = places[index];
      return shape("text", { x, y, "text-anchor": anchor }, name);
    }),
    ...[30, 60].map((degrees) =>
      shape("text", { x: 3, y: -RADIUS * (1 - degrees / 90) + 11, class: "faint" }, `${degrees}°`)),
  ];
}
