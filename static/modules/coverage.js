// Which directions of the target the voting frames measure: half the sphere on an equal-area disc.

import { degreesFromPlanes, fromDisc, leastSeen, nearestAxis, onDisc } from "./directions.js";
import { fixed, vector } from "./numbers.js";
import { clickDots, frameDots, shape } from "./svg.js";

const RADIUS = 96;
const SEEN_DEGREES = 12;
/** Colours at 0°, 30° and 90° from the nearest image plane; styles/hull.css draws the same scale. */
/** @type {[number, number[]][]} */
const STOPS = [[0, [18, 72, 70]], [30, [104, 84, 44]], [90, [255, 180, 84]]];

export class Coverage {
  #parts;
  #drawn = "";

  /** `parts.svg`, `parts.shade`, `parts.caption`; `go(number)` shows a frame. */
  constructor(parts, go) {
    this.#parts = parts;
    clickDots(parts.svg, go);
  }

  update({ sights = [], blind = [], frames_info: infos = [], shown }) {
    const { svg, caption } = this.#parts;
    const voting = blind.filter((_, index) => infos[index]?.votes);
    const key = JSON.stringify(voting);
    if (key !== this.#drawn) this.#shade(voting);
    this.#drawn = key;
    const worst = leastSeen(voting);
    const lacks = worst !== null && worst.degrees > SEEN_DEGREES;
    svg.replaceChildren(
      shape("circle", { r: RADIUS, class: "ring" }),
      ...axisNames(),
      ...frameDots(sights.map(onMap), shown, (number) => (infos[number - 1]?.votes ? "" : "mute")),
      ...(lacks ? [cross(onMap(worst.direction))] : []),
    );
    const found = worst === null
      ? "No frame votes yet."
      : lacks
        ? `Views lack most along ${vector(worst.direction)} (${nearestAxis(worst.direction)}), marked ×: ${fixed(worst.degrees, 0)}° off.`
        : `No direction is more than ${fixed(worst.degrees, 0)}° off: none lacks views.`;
    caption.replaceChildren(
      strong(found),
      " Shaded: angle to the nearest image plane of a voting frame. Dots: lines of sight, " +
        "opposite directions folded together, equal areas.",
    );
  }

  #shade(voting) {
    const { shade } = this.#parts;
    const context = shade.getContext("2d");
    const size = shade.width;
    const image = context.createImageData(size, size);
    const scale = 120 / RADIUS;
    for (let row = 0; row < size; row += 1) {
      for (let column = 0; column < size; column += 1) {
        const place = [column, row].map((at) => scale * ((2 * (at + 0.5)) / size - 1));
        const direction = fromDisc(...place);
        if (direction === null) continue;
        const at = 4 * (row * size + column);
        image.data.set([...colourAt(degreesFromPlanes(direction, voting)), 255], at);
      }
    }
    context.putImageData(image, 0, 0);
  }
}

/** @param {number} degrees */
function colourAt(degrees) {
  const next = STOPS.findIndex(([stop]) => stop >= degrees);
  const [[low, from], [high, to]] = next < 1 ? [STOPS[0], STOPS[1]] : [STOPS[next - 1], STOPS[next]];
  const share = (degrees - low) / (high - low);
  return from.map((value, channel) => value + share * (to[channel] - value));
}

function onMap(direction) {
  return onDisc(direction).map((value) => RADIUS * value);
}

function axisNames() {
  const names = [["x", 0, -RADIUS - 6, "middle"], ["y", RADIUS + 5, 4, "start"], ["z", 5, 12, "start"]];
  return [
    shape("path", { d: "M-4 0h8M0-4v8", class: "ring" }),
    ...names.map(([name, x, y, anchor]) => shape("text", { x, y, "text-anchor": anchor, class: name }, String(name))),
  ];
}

/** @param {number[]} place */
function cross([x, y]) {
  return shape("path", { d: `M${x - 5} ${y - 5}l10 10m0-10l-10 10`, class: "worst" });
}

function strong(text) {
  const made = document.createElement("b");
  made.textContent = text;
  return made;
}
