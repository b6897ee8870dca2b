// The radar frame on a canvas: levels in dB in true proportions, zoomed and moved, axes in metres.

import { MARGIN, drawAxes, drawBar } from "./axes.js";
import { paintLevels } from "./levels.js";
import { fixed, withUnit } from "./numbers.js";

const WIDEST_M = 4000;
const CLOSEST_PX = 200;

export class FrameView {
  #canvas;
  #picture = document.createElement("canvas");
  #colours = null;
  #frame = null;
  #levels = null;
  #floorDb = -40;
  #topDb = 0;
  #windowM = null;
  #part = null;
  #onDraw;

  /** Draw on `canvas`; call `onDraw` with where the frame lies after each drawing. */
  constructor(canvas, onRead, onDraw) {
    this.#canvas = canvas;
    this.#onDraw = onDraw;
    canvas.addEventListener("pointermove", (event) => onRead(this.#read(event)));
    canvas.addEventListener("pointerleave", () => onRead(null));
    new ResizeObserver(() => this.#draw()).observe(canvas);
  }

  /** Whether somebody zoomed or moved away from what fits. */
  get isFree() {
    return this.#part !== null;
  }

  get hasFrame() {
    return this.#frame !== null && this.#levels !== null;
  }

  setColours(table) {
    this.#colours = table;
    this.#paint();
  }

  setFrame(frame, levels) {
    // A part chosen in metres means nothing on a frame in pixels.
    if ((frame.row_spacing_m === null) !== (this.#frame?.row_spacing_m === null)) this.#part = null;
    this.#frame = frame;
    this.#levels = levels;
    this.#paint();
  }

  clear() {
    this.#frame = null;
    this.#levels = null;
    this.#draw();
  }

  /** Show levels from `floorDb` to `topDb`. */
  setLevels(floorDb, topDb) {
    this.#floorDb = floorDb;
    this.#topDb = topDb;
    this.#paint();
  }

  /** Fit a square of so many metres around the target, or the whole frame for null. */
  fit(metres) {
    this.#windowM = metres;
    this.#part = null;
    this.#draw();
  }

  /** Set the size that fits the target, and leave a part that somebody zoomed to. */
  setWindow(metres) {
    if (metres === this.#windowM) return;
    this.#windowM = metres;
    this.#draw();
  }

  /** Zoom by a factor about a place on the canvas, by default the plot's middle. */
  zoom(factor, place) {
    if (!this.hasFrame) return;
    const plot = this.plot();
    const [x, y] = place ?? [plot.x + plot.width / 2, plot.y + plot.height / 2];
    const current = this.#part ?? partOf(plot);
    const least = Math.min(plot.width, plot.height) / WIDEST_M;
    const most = CLOSEST_PX / Math.min(plot.rowM, plot.columnM);
    const perMetre = Math.min(Math.max(current.perMetre * factor, least), most);
    const shift = (offset) => offset / current.perMetre - offset / perMetre;
    this.#part = {
      perMetre,
      rangeM: current.rangeM + shift(y - plot.y - plot.height / 2),
      crossM: current.crossM + shift(x - plot.x - plot.width / 2),
    };
    this.#draw();
  }

  /** Move the picture by so many CSS pixels. */
  pan(dx, dy) {
    if (!this.hasFrame) return;
    const current = this.#part ?? partOf(this.plot());
    this.#part = {
      ...current,
      rangeM: current.rangeM - dy / current.perMetre,
      crossM: current.crossM - dx / current.perMetre,
    };
    this.#draw();
  }

  /** Where which part of the frame is drawn: places in CSS pixels, the part in frame pixels. */
  plot() {
    const { clientWidth, clientHeight } = this.#canvas;
    const frame = this.#frame;
    const [rowM, columnM] = [frame.row_spacing_m ?? 1, frame.column_spacing_m ?? 1];
    const [originRow, originColumn] = frame.origin_px;
    const width = Math.max(clientWidth - MARGIN.left - MARGIN.right, 1);
    const height = Math.max(clientHeight - MARGIN.top - MARGIN.bottom, 1);
    const part = this.#part ?? this.#fitted(width, height, rowM, columnM);
    const [rows, columns] = [height / part.perMetre / rowM, width / part.perMetre / columnM];
    return {
      x: MARGIN.left,
      y: MARGIN.top,
      width,
      height,
      row: originRow + part.rangeM / rowM - rows / 2,
      column: originColumn + part.crossM / columnM - columns / 2,
      rows,
      columns,
      originRow,
      originColumn,
      rowM,
      columnM,
    };
  }

  /** The frame's (row, column) at a place on the canvas. */
  pixelAt(x, y) {
    const plot = this.plot();
    return [
      plot.row + ((y - plot.y) / plot.height) * plot.rows,
      plot.column + ((x - plot.x) / plot.width) * plot.columns,
    ];
  }

  #fitted(width, height, rowM, columnM) {
    const frame = this.#frame;
    if (this.#windowM !== null && frame.row_spacing_m !== null) {
      return { perMetre: Math.min(width, height) / this.#windowM, rangeM: 0, crossM: 0 };
    }
    const [rows, columns] = frame.shape;
    const [originRow, originColumn] = frame.origin_px;
    return {
      perMetre: Math.min(width / (columns * columnM), height / (rows * rowM)),
      rangeM: ((rows - 1) / 2 - originRow) * rowM,
      crossM: ((columns - 1) / 2 - originColumn) * columnM,
    };
  }

  #paint() {
    if (!this.#levels || !this.#colours) return;
    paintLevels(this.#picture, this.#levels, this.#colours, this.#floorDb, this.#topDb);
    this.#draw();
  }

  #draw() {
    const canvas = this.#canvas;
    const scale = window.devicePixelRatio;
    canvas.width = Math.round(canvas.clientWidth * scale);
    canvas.height = Math.round(canvas.clientHeight * scale);
    if (!this.hasFrame || !this.#colours) {
      this.#onDraw(null);
      return;
    }
    const context = canvas.getContext("2d", { willReadFrequently: true });
    context.setTransform(scale, 0, 0, scale, 0, 0);
    const plot = this.plot();
    // Tests and tools read here where pixels of the frame lie on the canvas.
    canvas.dataset.plot = JSON.stringify(plot);
    this.#drawPicture(context, plot);
    drawAxes(context, plot, this.#frame.row_spacing_m === null ? "px" : "m");
    drawBar(context, plot, this.#colours, this.#floorDb, this.#topDb);
    this.#onDraw(plot);
  }

  #drawPicture(context, plot) {
    context.save();
    clipTo(context, plot);
    const [red, green, blue] = this.#colours[0];
    context.fillStyle = `rgb(${red} ${green} ${blue})`;
    context.fill();
    context.imageSmoothingEnabled = false;
    const [rows, columns] = this.#frame.shape;
    const [left, top] = onCanvas(plot, -0.5, -0.5);
    const [right, bottom] = onCanvas(plot, rows - 0.5, columns - 0.5);
    context.drawImage(this.#picture, left, top, right - left, bottom - top);
    context.restore();
  }

  #read({ offsetX: x, offsetY: y }) {
    if (!this.hasFrame) return null;
    const plot = this.plot();
    const [row, column] = this.pixelAt(x, y);
    const { rows, columns, numbers, floorDb, stepDb } = this.#levels;
    const [r, c] = [Math.round(row), Math.round(column)];
    if (!isInside(plot, x, y) || r < 0 || c < 0 || r >= rows || c >= columns) return null;
    const unit = this.#frame.row_spacing_m === null ? "px" : "m";
    return {
      range: withUnit((row - plot.originRow) * plot.rowM, 2, unit),
      crossRange: withUnit((column - plot.originColumn) * plot.columnM, 2, unit),
      level: withUnit(floorDb + numbers[r * columns + c] * stepDb, 1, "dB"),
      pixel: `${fixed(r, 0)}, ${fixed(c, 0)}`,
    };
  }
}

/** Keep what is drawn from here on within the plot. */
export function clipTo(context, plot) {
  context.beginPath();
  context.rect(plot.x, plot.y, plot.width, plot.height);
  context.clip();
}

/** Where a (row, column) of the frame lies on the canvas. */
export function onCanvas(plot, row, column) {
  return [
    plot.x + ((column - plot.column) / plot.columns) * plot.width,
    plot.y + ((row - plot.row) / plot.rows) * plot.height,
  ];
}

export function isInside(plot, x, y) {
  return x >= plot.x && x <= plot.x + plot.width && y >= plot.y && y <= plot.y + plot.height;
}

/** The part that a plot shows: its middle in metres from the origin, and its scale. */
function partOf(plot) {
  return {
    perMetre: plot.height / (plot.rows * plot.rowM),
    rangeM: (plot.row + plot.rows / 2 - plot.originRow) * plot.rowM,
    crossM: (plot.column + plot.columns / 2 - plot.originColumn) * plot.columnM,
  };
}
