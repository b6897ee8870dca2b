// The picture with its axes and what lies over it, as one file.

import { HATCHES, hatchPattern } from "./hatching.js";

const HEAD_PX = 48;
const ROW_PX = 22;
const EDGE_PX = 14;
const GROUND = "#11161f";
const FAMILY = 'system-ui, "Segoe UI", "Helvetica Neue", "Noto Sans", "DejaVu Sans", sans-serif';

/** Lay canvases of one size over each other, under a title and over a legend, in device pixels. */
export function composed(canvases, { title, stamp, legend }) {
  const scale = window.devicePixelRatio;
  const [{ width, height }] = canvases;
  const whole = document.createElement("canvas");
  const context = whole.getContext("2d");
  const rows = rowsOf(context, legend, width / scale);
  const head = Math.round(HEAD_PX * scale);
  Object.assign(whole, { width, height: height + head + Math.round((rows.length + 0.6) * ROW_PX * scale) });
  context.fillStyle = GROUND;
  context.fillRect(0, 0, whole.width, whole.height);
  for (const canvas of canvases) context.drawImage(canvas, 0, head);
  context.scale(scale, scale);
  context.textBaseline = "middle";
  const widest = width / scale - 2 * EDGE_PX;
  write(context, title, EDGE_PX, 17, "600 14px", "#dde3ec", widest);
  write(context, stamp, EDGE_PX, 36, "13px", "#98a4b5", widest);
  rows.forEach((row, index) => drawRow(context, row, (height + head) / scale + (index + 0.7) * ROW_PX));
  return whole;
}

/** Give a canvas to the browser to save under a name. */
export function download(canvas, name) {
  canvas.toBlob((blob) => {
    const address = URL.createObjectURL(blob);
    Object.assign(document.createElement("a"), { href: address, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(address), 10_000);
  });
}

/** "radarhull-tiangong-pass-1-frame12.png": of letters and figures that any file system takes. */
export function fileName(source, number) {
  const plain = source.normalize("NFKD").toLowerCase().replace(/[^a-z0-9]+/g, "-");
  const slug = plain.replace(/^-|-$/g, "").slice(0, 60) || "source";
  return `radarhull-${slug}-frame${number}.png`;
}

/** Entries of a legend in as many rows as they need, each [kind of hatch or colour, text, x]. */
function rowsOf(context, entries, width) {
  const rows = [[]];
  let x = EDGE_PX;
  context.font = `12.5px ${FAMILY}`;
  for (const [kind, text] of entries) {
    const needed = 24 + context.measureText(text).width;
    if (x + needed > width - EDGE_PX && rows.at(-1).length > 0) {
      rows.push([]);
      x = EDGE_PX;
    }
    rows.at(-1).push([kind, text, x]);
    x += needed + 18;
  }
  return rows;
}

function drawRow(context, row, y) {
  for (const [kind, text, x] of row) {
    const isHatch = kind in HATCHES;
    if (isHatch) {
      context.globalAlpha = 0.3;
      context.fillStyle = HATCHES[kind].colour;
      context.fillRect(x, y - 6, 18, 12);
      context.globalAlpha = 1;
    }
    context.fillStyle = isHatch ? hatchPattern(context, kind) : kind;
    context.fillRect(x, isHatch ? y - 6 : y - 1, 18, isHatch ? 12 : 2);
    write(context, text, x + 24, y, "12.5px", "#dde3ec");
  }
}

/** Write text, made narrower where it is wider than `widest`. */
function write(context, text, x, y, font, colour, widest) {
  context.font = `${font} ${FAMILY}`;
  context.fillStyle = colour;
  context.fillText(text, x, y, widest);
}
