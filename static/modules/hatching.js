// Hatches, so that nobody has to tell areas apart by their hue alone.

import { cleared } from "./canvas.js";

/** How each area is hatched: [hue, tint of the whole area, lines, CSS pixels between them]. */
export const HATCHES = {
  onlyOutline: { colour: "#5fd68a", tint: 0.22, lines: "rising", step: 7, alpha: 0.95 },
  onlyHull: { colour: "#6f8cff", tint: 0.22, lines: "falling", step: 7, alpha: 0.95 },
  shadow: { colour: "#b9c4d6", tint: 0.05, lines: "along range", step: 6, alpha: 0.28 },
};

/** Lines through a tile of so many pixels, each [x, y, to x, to y], that go on in the next tile. */
const LINES = {
  rising: (size) => [0, size, 2 * size].map((sum) => [sum, 0, sum - 2 * size, 2 * size]),
  falling: (size) => [-size, 0, size].map((shift) => [shift, 0, shift + 2 * size, 2 * size]),
  "along range": (size) => [[size / 2, 0, size / 2, size]],
};

/** Hatch what `trace(context)` fills by a rule, less what later traces fill, on `context`. */
export class Hatcher {
  #scratch = document.createElement("canvas");

  /** `parts` is the area first, then what is taken out of it, each [trace, rule of filling]. */
  draw(context, kind, parts) {
    const [[trace, rule], ...taken] = parts;
    const { canvas } = context;
    const scratch = this.#scratch;
    const part = cleared(scratch, canvas.width, canvas.height);
    part.setTransform(context.getTransform());
    const { colour, tint, alpha } = HATCHES[kind];
    trace(part);
    part.fillStyle = colour;
    part.globalAlpha = tint;
    part.fill(rule);
    part.fillStyle = hatchPattern(part, kind);
    part.globalAlpha = alpha;
    part.fill(rule);
    // The pattern lets through between its lines; what is taken out goes whole.
    part.fillStyle = colour;
    part.globalAlpha = 1;
    part.globalCompositeOperation = "destination-out";
    for (const [traceTaken, ruleTaken] of taken) {
      traceTaken(part);
      part.fill(ruleTaken);
    }
    context.save();
    context.resetTransform();
    context.drawImage(scratch, 0, 0);
    context.restore();
  }
}

/** Lines that keep their width on screen, drawn at the device's resolution. */
export function hatchPattern(context, kind) {
  const { colour, lines, step } = HATCHES[kind];
  const scale = context.getTransform().a;
  const size = Math.round(step * scale);
  const tile = Object.assign(document.createElement("canvas"), { width: size, height: size });
  const drawn = tile.getContext("2d", { willReadFrequently: true });
  drawn.strokeStyle = colour;
  drawn.lineWidth = 1.25 * scale;
  for (const [x, y, toX, toY] of LINES[lines](size)) {
    drawn.beginPath();
    drawn.moveTo(x, y);
    drawn.lineTo(toX, toY);
    drawn.stroke();
  }
  const made = context.createPattern(tile, "repeat");
  made.setTransform(new DOMMatrix().scale(1 / scale));
  return made;
}
