// Key points over the picture: marks as crosses, and where they should be as circles and lines.

import { onCanvas } from "./frame-view.js";

export const KEY_POINT = "#ffb048";
const OTHER = "#e8d9c2";
const BAD = "#ff7b72";
const SHADE = "rgb(5 8 14 / 75%)";
const ARM_PX = 8;
const GAP_PX = 2.5;
const RING_PX = 7;
const FONT = '600 12px system-ui, "Segoe UI", "Helvetica Neue", "Noto Sans", "DejaVu Sans", sans-serif';

/** Draw marks, and while somebody marks also where the points should be seen. */
export function drawKeyPoints(context, plot, { marks, expected, active, isMarking }) {
  const at = ({ row, column }) => onCanvas(plot, row, column);
  if (isMarking) {
    for (const { name, place, lines } of expected) {
      const mark = marks.find((each) => each.name === name);
      const colour = name === active ? KEY_POINT : OTHER;
      for (const line of lines) if (!mark || name === active) dashed(context, plot, line, colour);
      if (place) drawExpected(context, onCanvas(plot, ...place), mark && at(mark), name, colour);
    }
  }
  for (const mark of marks) {
    const colour = mark.is_suspicious ? BAD : mark.name === active && isMarking ? KEY_POINT : OTHER;
    cross(context, at(mark), colour);
    label(context, at(mark), mark.name, colour);
  }
}

/** An open circle where the point is projected, joined to its mark; named where there is no mark. */
function drawExpected(context, place, mark, name, colour) {
  stroked(context, colour, 1.5, () => {
    context.arc(...place, RING_PX, 0, 2 * Math.PI);
    if (!mark) return;
    context.moveTo(...place);
    context.lineTo(...mark);
  });
  if (!mark) label(context, place, `${name}?`, colour);
}

function dashed(context, plot, [start, end], colour) {
  context.setLineDash([6, 4]);
  stroked(context, colour, 1.25, () => {
    context.moveTo(...onCanvas(plot, ...start));
    context.lineTo(...onCanvas(plot, ...end));
  });
  context.setLineDash([]);
}

/** A cross whose middle leaves the corner free to be seen. */
function cross(context, place, colour) {
  const [x, y] = place;
  stroked(context, colour, 1.75, () => {
    for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
      context.moveTo(x + GAP_PX * dx, y + GAP_PX * dy);
      context.lineTo(x + ARM_PX * dx, y + ARM_PX * dy);
    }
  });
}

function stroked(context, colour, width, trace) {
  context.beginPath();
  trace();
  context.strokeStyle = SHADE;
  context.lineWidth = width + 2;
  context.stroke();
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.stroke();
}

function label(context, place, text, colour) {
  const [x, y] = place;
  context.font = FONT;
  context.textAlign = "left";
  context.textBaseline = "bottom";
  context.lineJoin = "round";
  context.strokeStyle = SHADE;
  context.lineWidth = 3.5;
  context.strokeText(text, x + ARM_PX, y - 4);
  context.fillStyle = colour;
  context.fillText(text, x + ARM_PX, y - 4);
}
