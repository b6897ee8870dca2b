// The radar frame on a canvas: levels in dB in true proportions, axes in metres, silhouette.

import { fixed, roundSteps, withUnit } from "./numbers.js";

const MARGIN = { left: 50, top: 6, right: 62, bottom: 42 };
const BAR = { gap: 14, width: 12 };
const TEXT = "#8f9bad";
const OUTLINE = "#40e0d0";
const FONT = '12px system-ui, "Segoe UI", "Helvetica Neue", "Noto Sans", "DejaVu Sans", sans-serif';

export class FrameView {
  #canvas;
  #picture = document.createElement("canvas");
  #colours = null;
  #frame = null;
  #levels = null;
  #floorDb = -40;
  #windowM = null;

  /** Draw on `canvas`; tell `onRead` what is under the cursor, null when nothing is. */
  constructor(canvas, onRead) {
    this.#canvas = canvas;
    canvas.addEventListener("pointermove", (event) => onRead(this.#read(event)));
    canvas.addEventListener("pointerleave", () => onRead(null));
    new ResizeObserver(() => this.#draw()).observe(canvas);
  }

  setColours(table) {
    this.#colours = table;
    this.#paint();
  }

  setFrame(frame, levels) {
    this.#frame = frame;
    this.#levels = levels;
    this.#paint();
  }

  clear() {
    this.#frame = null;
    this.#levels = null;
    this.#draw();
  }

  setFloor(decibels) {
    this.#floorDb = decibels;
    this.#paint();
  }

  /** Show a square of so many metres around the target, or the whole frame for null. */
  setWindow(metres) {
    this.#windowM = metres;
    this.#draw();
  }

  /** Colour the levels, one pixel each. */
  #paint() {
    if (!this.#levels || !this.#colours) return;
    const { rows, columns, numbers } = this.#levels;
    this.#picture.width = columns;
    this.#picture.height = rows;
    const context = this.#picture.getContext("2d");
    const image = context.createImageData(columns, rows);
    const pixels = new Uint32Array(image.data.buffer);
    const colourOf = this.#coloursOfNumbers();
    for (let place = 0; place < numbers.length; place += 1) {
      pixels[place] = colourOf[numbers[place]];
    }
    context.putImageData(image, 0, 0);
    this.#draw();
  }

  /** The pixel, in the machine's byte order, for each of the 65536 numbers a level can have. */
  #coloursOfNumbers() {
    const { floorDb, stepDb } = this.#levels;
    const bytes = new Uint8Array(4 * this.#colours.length);
    this.#colours.forEach((colour, index) => bytes.set([...colour, 255], 4 * index));
    const pixelOfIndex = new Uint32Array(bytes.buffer);
    const colourOf = new Uint32Array(65536);
    for (let number = 0; number < colourOf.length; number += 1) {
      const share = 1 - (floorDb + number * stepDb) / this.#floorDb;
      colourOf[number] = pixelOfIndex[Math.floor(Math.min(Math.max(share, 0), 1) * 255 + 0.5)];
    }
    return colourOf;
  }

  #draw() {
    const canvas = this.#canvas;
    const scale = window.devicePixelRatio;
    const { clientWidth: width, clientHeight: height } = canvas;
    canvas.width = Math.round(width * scale);
    canvas.height = Math.round(height * scale);
    if (!this.#frame || !this.#levels) return;
    const context = canvas.getContext("2d");
    context.setTransform(scale, 0, 0, scale, 0, 0);
    context.font = FONT;
    const plot = this.#plot(width, height);
    // Tests and tools read here where pixels of the frame lie on the canvas.
    canvas.dataset.plot = JSON.stringify(plot);
    this.#drawPicture(context, plot);
    this.#drawOutline(context, plot);
    this.#drawAxes(context, plot);
    this.#drawBar(context, plot);
  }

  /** Where which part of the frame is drawn: places in CSS pixels, the part in frame pixels. */
  #plot(width, height) {
    const frame = this.#frame;
    const [rowM, columnM] = [frame.row_spacing_m ?? 1, frame.column_spacing_m ?? 1];
    const [originRow, originColumn] = frame.origin_px;
    const part = { row: -0.5, column: -0.5, rows: frame.shape[0], columns: frame.shape[1] };
    if (this.#windowM !== null && frame.row_spacing_m !== null) {
      part.rows = this.#windowM / rowM;
      part.columns = this.#windowM / columnM;
      part.row = originRow - part.rows / 2;
      part.column = originColumn - part.columns / 2;
    }
    const room = [width - MARGIN.left - MARGIN.right, height - MARGIN.top - MARGIN.bottom];
    const size = [part.columns * columnM, part.rows * rowM];
    const perMetre = Math.min(room[0] / size[0], room[1] / size[1]);
    const plot = { width: size[0] * perMetre, height: size[1] * perMetre };
    plot.x = MARGIN.left + (room[0] - plot.width) / 2;
    plot.y = MARGIN.top;
    return { ...plot, ...part, originRow, originColumn, rowM, columnM };
  }

  #drawPicture(context, plot) {
    context.save();
    context.beginPath();
    context.rect(plot.x, plot.y, plot.width, plot.height);
    context.clip();
    context.fillStyle = "#000004";
    context.fill();
    context.imageSmoothingEnabled = false;
    const [left, top] = onCanvas(plot, -0.5, -0.5);
    const [right, bottom] = onCanvas(
      plot,
      this.#frame.shape[0] - 0.5,
      this.#frame.shape[1] - 0.5,
    );
    context.drawImage(this.#picture, left, top, right - left, bottom - top);
    context.restore();
    context.strokeStyle = "#3b475b";
    context.lineWidth = 1;
    context.strokeRect(plot.x - 0.5, plot.y - 0.5, plot.width + 1, plot.height + 1);
  }

  #drawOutline(context, plot) {
    context.save();
    context.beginPath();
    context.rect(plot.x, plot.y, plot.width, plot.height);
    context.clip();
    context.beginPath();
    for (const ring of this.#frame.silhouette.rings) {
      ring.forEach(([row, column], index) => {
        const place = onCanvas(plot, row, column);
        if (index === 0) context.moveTo(...place);
        else context.lineTo(...place);
      });
      context.closePath();
    }
    context.strokeStyle = OUTLINE;
    context.lineWidth = 1.5;
    context.lineJoin = "round";
    context.stroke();
    context.restore();
  }

  #drawAxes(context, plot) {
    const lastCrossOffset = plot.columns * plot.columnM;
    const unit = this.#frame.row_spacing_m === null ? "px" : "m";
    const firstRange = (plot.row - plot.originRow) * plot.rowM;
    const firstCross = (plot.column - plot.originColumn) * plot.columnM;
    const perMetre = plot.height / (plot.rows * plot.rowM);
    context.fillStyle = TEXT;
    context.strokeStyle = "#3b475b";
    context.textAlign = "center";
    context.textBaseline = "top";
    for (const { value, text } of roundSteps(firstCross, firstCross + lastCrossOffset, 8)) {
      const x = plot.x + (value - firstCross) * perMetre;
      tick(context, x, plot.y + plot.height + 1, 0, 4);
      context.fillText(text, x, plot.y + plot.height + 7);
    }
    context.textAlign = "right";
    context.textBaseline = "middle";
    const lastRange = firstRange + plot.rows * plot.rowM;
    for (const { value, text } of roundSteps(firstRange, lastRange, 8)) {
      const y = plot.y + (value - firstRange) * perMetre;
      tick(context, plot.x - 1, y, -4, 0);
      context.fillText(text, plot.x - 8, y);
    }
    this.#drawTitles(context, plot, unit);
  }

  #drawTitles(context, plot, unit) {
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

  #drawBar(context, plot) {
    const x = plot.x + plot.width + BAR.gap;
    const height = plot.height;
    for (let pixel = 0; pixel < height; pixel += 1) {
      const [red, green, blue] = this.#colours[Math.round(255 * (1 - pixel / (height - 1)))] ?? [];
      context.fillStyle = `rgb(${red} ${green} ${blue})`;
      context.fillRect(x, plot.y + pixel, BAR.width, 1.5);
    }
    context.fillStyle = TEXT;
    context.textAlign = "left";
    context.textBaseline = "middle";
    for (const { value, text } of roundSteps(this.#floorDb, 0, 5)) {
      const y = plot.y + (value / this.#floorDb) * height;
      const inside = Math.min(Math.max(y, plot.y + 6), plot.y + height - 6);
      context.fillText(text, x + BAR.width + 6, inside);
    }
    context.textBaseline = "top";
    context.fillText("dB", x - 1, plot.y + height + 7);
  }

  #read(event) {
    if (!this.#frame || !this.#levels) return null;
    const plot = JSON.parse(this.#canvas.dataset.plot);
    const row = plot.row + ((event.offsetY - plot.y) / plot.height) * plot.rows;
    const column = plot.column + ((event.offsetX - plot.x) / plot.width) * plot.columns;
    const { rows, columns, numbers, floorDb, stepDb } = this.#levels;
    const [r, c] = [Math.round(row), Math.round(column)];
    const isInside =
      event.offsetX >= plot.x && event.offsetX <= plot.x + plot.width &&
      event.offsetY >= plot.y && event.offsetY <= plot.y + plot.height;
    if (!isInside || r < 0 || c < 0 || r >= rows || c >= columns) return null;
    const unit = this.#frame.row_spacing_m === null ? "px" : "m";
    return {
      range: withUnit((row - plot.originRow) * plot.rowM, 2, unit),
      crossRange: withUnit((column - plot.originColumn) * plot.columnM, 2, unit),
      level: withUnit(floorDb + numbers[r * columns + c] * stepDb, 1, "dB"),
      pixel: `${fixed(r, 0)}, ${fixed(c, 0)}`,
    };
  }
}

function onCanvas(plot, row, column) {
  return [
    plot.x + ((column - plot.column) / plot.columns) * plot.width,
    plot.y + ((row - plot.row) / plot.rows) * plot.height,
  ];
}

function tick(context, x, y, dx, dy) {
  context.beginPath();
  context.moveTo(x, y);
  context.lineTo(x + dx, y + dy);
  context.stroke();
}
