// Plots of passes over time (uPlot), with the verdict on each interval as a shade behind them.

import uPlot from "../vendor/uPlot.esm.js";
import { fixed, roundSteps } from "./numbers.js";
import { plotted, values } from "./quantities.js";

const AXIS_HEIGHT = 17;
const SIDE = 40;
const TICK_FONT = "11px system-ui, sans-serif";
const MUTED = "#8f9bad";
const LINE = "#232c3a";
const SHADES = { rejected: "rgb(255 123 114 / 20%)", shortened: "rgb(255 180 84 / 11%)" };
const HATCH = "rgb(255 123 114 / 55%)";
const HATCH_STEP = 6;
const MONTHS = ["Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"];

export class CoursePlots {
  #host;
  #on;
  #plots = [];
  #axis = null;
  #frames = [];
  #shown = null;
  #ticksShown = null;

  /**
   * Draw into `host`; `on.point(place or null, left)` follows the pointer,
   * `on.wish(place)` and `on.end()` a press.
   */
  constructor(host, on) {
    this.#host = host;
    this.#on = on;
    new ResizeObserver(() => this.#fit()).observe(host);
  }

  get quantities() {
    return this.#plots.flatMap((each) => each.quantities);
  }

  /** Plot the passes of an axis. */
  show(axis) {
    this.#plots.forEach((each) => each.plot.destroy());
    this.#axis = axis;
    const rows = plotted(axis.spans.map((span) => span.pass));
    this.#plots = rows.map((quantities, index) => this.#plot(quantities, index === rows.length - 1));
    this.#host.dataset.plots = String(rows.length);
    this.#ticksShown = null;
    this.#fit();
    this.setFrames(this.#frames, this.#shown);
  }

  /** Mark where frames lie, and the one that is shown; news come often, and most move only that. */
  setFrames(frames, shown) {
    this.#frames = frames;
    this.#shown = shown;
    const ticksShown = frames.join();
    for (const { plot, mark, ticks } of this.#plots) {
      if (ticks !== null && ticksShown !== this.#ticksShown) {
        drawTicks(ticks, frames.filter((at) => at !== null).map((at) => plot.valToPos(at, "x")));
        this.#ticksShown = ticksShown;
      }
      const place = frames[shown - 1] ?? null;
      mark.hidden = place === null;
      if (place !== null) mark.style.transform = `translateX(${plot.valToPos(place, "x")}px)`;
    }
  }

  #plot(quantities, isLast) {
    const plot = new uPlot(this.#options(quantities, isLast), this.#data(quantities), this.#host);
    const mark = document.createElement("div");
    mark.className = "frame-mark";
    mark.hidden = true;
    const ticks = isLast ? document.createElement("canvas") : null;
    if (isLast) ticks.className = "frame-ticks";
    plot.over.append(mark, ...(isLast ? [ticks] : []));
    this.#listen(plot);
    return { plot, mark, ticks, quantities, isLast };
  }

  #options(quantities, isLast) {
    const side = (quantity, index) => ({
      scale: quantity.key,
      side: index === 0 ? 3 : 1,
      size: SIDE,
      gap: 4,
      font: TICK_FONT,
      stroke: quantity.colour,
      grid: { show: index === 0, stroke: LINE, width: 1 },
      ticks: { show: false },
      splits: () => quantity.ticks,
      values: () => quantity.texts ?? quantity.ticks.map((value) => fixed(value, 0)),
    });
    const scale = ({ key, range }) => [key, { range }];
    const padding = quantities.length === 1 ? SIDE : 0;
    return {
      ...this.#size(isLast),
      padding: [7, padding, isLast ? 0 : 3, 0],
      legend: { show: false },
      cursor: { drag: { x: false, y: false }, y: false, sync: { key: "course" }, points: { size: 7 } },
      scales: {
        x: { time: false, range: () => [0, this.#axis.length] },
        ...Object.fromEntries(quantities.map(scale)),
      },
      axes: [this.#timeAxis(isLast), ...quantities.map(side)],
      series: [
        {},
        ...quantities.map((quantity) => ({
          scale: quantity.key,
          stroke: quantity.colour,
          dash: quantity.dash,
          width: 1.6,
          points: { show: false },
        })),
      ],
      hooks: {
        drawClear: [(plot) => this.#shade(plot)],
        draw: isLast ? [(plot) => this.#namePasses(plot)] : [],
        setCursor: [(plot) => this.#follow(plot)],
      },
    };
  }

  #timeAxis(isLast) {
    return {
      show: true,
      size: isLast ? AXIS_HEIGHT : 0,
      gap: 3,
      font: TICK_FONT,
      stroke: MUTED,
      grid: { stroke: LINE, width: 1 },
      ticks: { show: false },
      splits: () => this.#times().map((each) => each.place),
      values: () => (isLast ? this.#times().map((each) => each.text) : this.#times().map(() => "")),
    };
  }

  /** Round times into each pass; where it begins its name stands instead. */
  #times() {
    return this.#axis.spans.flatMap((span) => {
      const first = span.pass.time_s[0];
      const wanted = Math.max(2, Math.round((4 * (span.stop - span.start) * 3) / this.#axis.length));
      return roundSteps(first, span.pass.time_s.at(-1), Math.min(wanted, 8))
        .map(({ value, text }) => ({ place: this.#axis.place(span, value), text: `${text}\u202fs` }))
        .filter(({ place }) => place - span.start > this.#nameLength(span));
    });
  }

  #nameLength(span) {
    const perPixel = this.#axis.length / Math.max(this.#host.clientWidth - 2 * SIDE, 1);
    return (14 + 6.2 * nameOf(span.pass).length) * perPixel;
  }

  #data(quantities) {
    const { spans, gap } = this.#axis;
    const column = (ofPass) =>
      spans.flatMap((span, index) => [...ofPass(span), ...(index < spans.length - 1 ? [null] : [])]);
    const place = spans.flatMap((span, index) => [
      ...span.pass.time_s.map((time) => this.#axis.place(span, time)),
      ...(index < spans.length - 1 ? [span.stop + gap / 2] : []),
    ]);
    return [place, ...quantities.map((each) => column((span) => values(span.pass, each)))];
  }

  #shade({ ctx, bbox, valToPos }) {
    const position = (place) => valToPos(place, "x", true);
    ctx.save();
    for (const span of this.#axis.spans) {
      for (const { verdict, start, stop } of stretches(span.pass.intervals)) {
        const left = position(this.#axis.place(span, start));
        const width = position(this.#axis.place(span, stop)) - left;
        ctx.fillStyle = SHADES[verdict];
        ctx.fillRect(left, bbox.top, width, bbox.height);
        if (verdict === "rejected") hatch(ctx, left, bbox.top, width, bbox.height);
      }
    }
    ctx.fillStyle = "#0b0e14";
    this.#axis.spans.slice(1).forEach((span) => {
      const left = position(span.start - this.#axis.gap);
      ctx.fillRect(left, bbox.top, position(span.start) - left, bbox.height);
    });
    ctx.restore();
  }

  #namePasses({ ctx, bbox, valToPos }) {
    const ratio = devicePixelRatio;
    const bottom = bbox.top + bbox.height;
    ctx.save();
    ctx.fillStyle = "#dde3ec";
    ctx.font = TICK_FONT.replace("11", String(11 * ratio));
    ctx.textAlign = "left";
    ctx.textBaseline = "top";
    for (const span of this.#axis.spans) {
      ctx.fillText(nameOf(span.pass), valToPos(span.start, "x", true), bottom + 3 * ratio);
    }
    ctx.restore();
  }

  #listen({ over }) {
    const wish = (event) => {
      const { plot } = this.#plots.find((each) => each.plot.over === over);
      this.#on.wish(plot.posToVal(event.clientX - over.getBoundingClientRect().left, "x"));
    };
    over.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      over.setPointerCapture(event.pointerId);
      wish(event);
    });
    over.addEventListener("pointermove", (event) => {
      if (over.hasPointerCapture(event.pointerId)) wish(event);
    });
    over.addEventListener("lostpointercapture", () => this.#on.end());
  }

  #follow(plot) {
    const { left } = plot.cursor;
    const isOutside = left === undefined || left < 0;
    this.#on.point(isOutside ? null : plot.posToVal(left, "x"), plot.over.offsetLeft + left);
  }

  #size(isLast) {
    const rows = Math.max(this.#plots.length, Number(this.#host.dataset.plots) || 2);
    const height = Math.floor((this.#host.clientHeight - AXIS_HEIGHT) / rows);
    return { width: this.#host.clientWidth, height: Math.max(height, 20) + (isLast ? AXIS_HEIGHT : 0) };
  }

  #fit() {
    if (this.#host.clientWidth === 0) return;
    for (const { plot, isLast } of this.#plots) plot.setSize(this.#size(isLast));
    // uPlot takes a new size on in a microtask; places measured before it would be the old ones.
    queueMicrotask(() => {
      this.#ticksShown = null;
      this.setFrames(this.#frames, this.#shown);
    });
  }
}

/** Mark places along the bottom; a canvas of its own, for frames come often and curves do not. */
function drawTicks(canvas, places) {
  const ratio = devicePixelRatio;
  canvas.width = canvas.clientWidth * ratio;
  canvas.height = canvas.clientHeight * ratio;
  const ctx = canvas.getContext("2d");
  ctx.fillStyle = "#40e0d0";
  for (const place of places) ctx.fillRect((place - 0.5) * ratio, 0, ratio, canvas.height);
}

/** What a pass is called on the axis, with its beginning where an orbit tells it. */
function nameOf(pass) {
  const begin = pass.epoch_utc && new Date(pass.epoch_utc);
  const name = pass.label || "pass";
  if (!begin || Number.isNaN(begin.getTime())) return name;
  const day = `${begin.getUTCDate()} ${MONTHS[begin.getUTCMonth()]}`;
  return `${name}, ${day} ${begin.toISOString().slice(11, 16)} UTC`;
}

/** Runs of intervals of one verdict that is not the best, as one stretch each: few to draw. */
function stretches(intervals) {
  const found = [];
  for (const { verdict, start_s: start, stop_s: stop } of intervals) {
    if (verdict === "accepted") continue;
    const last = found.at(-1);
    // Between the pulses of neighbours lies one pulse interval.
    const isNext = last?.verdict === verdict && start - last.stop < 0.05 * (stop - start);
    if (isNext) last.stop = stop;
    else found.push({ verdict, start, stop });
  }
  return found;
}

function hatch(ctx, left, top, width, height) {
  ctx.save();
  ctx.beginPath();
  ctx.rect(left, top, width, height);
  ctx.clip();
  ctx.beginPath();
  const step = HATCH_STEP * devicePixelRatio;
  // Lines that start at multiples of the step meet across neighbouring intervals.
  for (let x = Math.floor((left - height) / step) * step; x < left + width; x += step) {
    ctx.moveTo(x, top + height);
    ctx.lineTo(x + height, top);
  }
  ctx.strokeStyle = HATCH;
  ctx.lineWidth = devicePixelRatio;
  ctx.stroke();
  ctx.restore();
}
