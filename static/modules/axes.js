// Axes in metres around a plot, and the bar of levels beside it.

import { roundSteps } from "./numbers.js";

export const MARGIN = { left: 50, top: 6, right: 62, bottom: 42 };
const BAR = { gap: 14, width: 12 };
const TEXT = "#98a4b5";
const LINE = "#3b475b";
const FONT = '12px system-ui, "Segoe UI", "Helvetica Neue", "Noto Sans", "DejaVu Sans", sans-serif';

/** Draw ticks, numbers and titles around `plot`, in `unit`. */
export function drawAxes(context, plot, unit) {
  const firstRange = (plot.row - plot.originRow) * plot.rowM;
  const lastRange = firstRange + plot.rows * plot.rowM;
  const firstCross = (plot.column - plot.originColumn) * plot.columnM;
  const lastCross = firstCross + plot.columns * plot.columnM;
  const perMetre = plot.height / (lastRange - firstRange);
  context.font = FONT;
  context.fillStyle = TEXT;
  context.strokeStyle = LINE;
  context.lineWidth = 1;
  context.strokeRect(plot.x - 0.5, plot.y - 0.5, plot.width + 1, plot.height + 1);
  context.textAlign = "center";
  context.textBaseline = "top";
  for (const { value, text } of roundSteps(firstCross, lastCross, 8)) {
    const x = plot.x + (value - firstCross) * perMetre;
    tick(context, x, plot.y + plot.height + 1, 0, 4);
    context.fillText(text, x, plot.y + plot.height + 7);
  }
  context.textAlign = "right";
  context.textBaseline = "middle";
  for (const { value, text } of roundSteps(firstRange, lastRange, 8)) {
    const y = plot.y + (value - firstRange) * perMetre;
    tick(context, plot.x - 1, y, -4, 0);
    context.fillText(text, plot.x - 8, y);
  }
  drawTitles(context, plot, unit);
}

function drawTitles(context, plot, unit) {
  context.textAlign = "center";
  context.textBaseline = "bottom";
  const below = plot.y + plot.height + 40;
  context.fillText(`cross-range, ${unit} →`, plot.x + plot.width / 2, below);
  context.save();
  context.translate(plot.x - 46, plot.y + plot.height / 2);
  context.rotate(-Math.PI / 2);
  context.textBaseline = "top";
  context.fillText(`← range from the origin, ${unit}`, 0, 0);
  context.restore();
}

/** Draw which colour stands for which level from `floorDb` to `topDb`. */
export function drawBar(context, plot, colours, floorDb, topDb) {
  const x = plot.x + plot.width + BAR.gap;
  const { height } = plot;
  for (let pixel = 0; pixel < height; pixel += 1) {
    const index = Math.round(255 * (1 - pixel / Math.max(height - 1, 1)));
    const [red, green, blue] = colours[Math.max(index, 0)];
    context.fillStyle = `rgb(${red} ${green} ${blue})`;
    context.fillRect(x, plot.y + pixel, BAR.width, 1.5);
  }
  context.font = FONT;
  context.fillStyle = TEXT;
  context.textAlign = "left";
  context.textBaseline = "middle";
  for (const { value, text } of roundSteps(floorDb, topDb, 5)) {
    const y = plot.y + ((topDb - value) / (topDb - floorDb)) * height;
    const inside = Math.min(Math.max(y, plot.y + 6), plot.y + height - 6);
    context.fillText(text, x + BAR.width + 6, inside);
  }
  context.textBaseline = "top";
  context.fillText("dB", x - 1, plot.y + height + 7);
}

function tick(context, x, y, dx, dy) {
  context.beginPath();
  context.moveTo(x, y);
  context.lineTo(x + dx, y + dy);
  context.stroke();
}
