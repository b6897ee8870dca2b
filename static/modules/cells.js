// The row of frames: a picture, the review state, and what each frame does to the hull.

import { Latest } from "./latest.js";
import { timeText, withUnit } from "./numbers.js";
import { STATES } from "./review.js";
import { Thumbnails } from "./thumbnails.js";

export class Cells {
  #host;
  #state = null;
  #inView = null;
  #thumbnails = new Thumbnails((number) => this.#nearness(number));
  #scrub;

  /** Fill `host`, a list box, and go to frames through the asynchronous `show(number or null)`. */
  constructor(host, show) {
    this.#host = host;
    this.#scrub = new Latest((number) => show(number === this.#state.frames ? null : number));
    new ResizeObserver(() => {
      this.#inView = null;
      if (this.#state) this.#bringIntoView();
    }).observe(host);
    host.addEventListener("click", (event) => this.#choose(event.target));
    host.addEventListener("pointermove", (event) => {
      if (event.buttons === 1) this.#choose(document.elementFromPoint(event.clientX, event.clientY));
    });
  }

  update(state) {
    this.#state = state;
    this.#thumbnails.noteNews();
    const wanted = Math.max(state.source.expected_frames ?? 0, state.frames);
    const cells = this.#host.children;
    while (cells.length > wanted) this.#host.lastChild.remove();
    while (cells.length < wanted) this.#host.append(document.createElement("div"));
    const residuals = scaledResiduals(state);
    this.#host.classList.toggle("with-residuals", residuals !== null);
    this.#host.classList.toggle("old-residuals", residuals?.isOld ?? false);
    [...cells].forEach((cell, index) => this.#fill(cell, index + 1, residuals));
    this.#bringIntoView();
  }

  #fill(cell, number, residuals) {
    const state = this.#state;
    cell.classList.toggle("received", number <= state.frames);
    cell.classList.toggle("latest", number === state.frames);
    cell.classList.toggle("shown", number === state.shown);
    if (number > state.frames) {
      empty(cell);
      return;
    }
    if (!cell.firstChild) furnish(cell, number);
    const info = state.frames_info?.[number - 1];
    cell.ariaSelected = String(number === state.shown);
    cell.dataset.state = info?.state ?? "todo";
    cell.classList.toggle("edited", Boolean(info?.edited));
    const residual = residuals?.of.get(number);
    showBars(cell, residual);
    cell.title = words(state, number, info, residual).join(", ");
    cell.ariaLabel = cell.title;
    this.#thumbnails.want(cell.querySelector("img"), number, `${state.run}-${info?.revision ?? 0}`);
  }

  #choose(target) {
    const number = Number(target?.closest?.("#cells [data-number]")?.dataset.number);
    if (number && number !== this.#state.shown) this.#scrub.ask(number);
  }

  /** Scroll to the frame on show when it changes; in between the row may be scrolled freely. */
  #bringIntoView() {
    const cell = this.#host.children[(this.#state.shown ?? 0) - 1];
    if (!cell) return;
    this.#host.setAttribute("aria-activedescendant", cell.id);
    if (this.#inView === cell.id) return;
    this.#inView = cell.id;
    const { scrollLeft, clientWidth } = this.#host;
    const left = cell.offsetLeft - this.#host.offsetLeft;
    // A neighbour stays in sight on either side.
    const margin = 1.5 * cell.offsetWidth;
    if (left - margin < scrollLeft) this.#host.scrollLeft = left - margin;
    else if (left + cell.offsetWidth + margin > scrollLeft + clientWidth) {
      this.#host.scrollLeft = left + cell.offsetWidth + margin - clientWidth;
    }
  }

  #nearness(number) {
    const cell = this.#host.children[number - 1];
    const middle = this.#host.offsetLeft + this.#host.scrollLeft + this.#host.clientWidth / 2;
    return cell ? Math.abs(cell.offsetLeft + cell.offsetWidth / 2 - middle) : Infinity;
  }
}

function furnish(cell, number) {
  cell.id = `frame-${number}`;
  cell.dataset.number = number;
  cell.role = "option";
  const image = document.createElement("img");
  image.alt = "";
  image.draggable = false;
  const bars = document.createElement("span");
  bars.className = "bars";
  bars.append(bar("causes"), bar("suffers"));
  const band = document.createElement("span");
  band.className = "band";
  cell.append(image, bars, band);
}

function bar(name) {
  const made = document.createElement("i");
  made.className = name;
  return made;
}

function empty(cell) {
  for (const name of ["role", "title", "aria-label", "aria-selected", "id"]) cell.removeAttribute(name);
  delete cell.dataset.number;
  delete cell.dataset.state;
  cell.classList.remove("edited");
  cell.replaceChildren();
}

function words(state, number, info, residual) {
  const time = timeText(state.times_s[number - 1], state.labels[number - 1]);
  const review = info && info.state !== "todo" ? [STATES[info.state]] : [];
  const edited = info?.edited ? ["edited"] : [];
  const residuals = residual
    ? [
        `causes ${withUnit(residual.causes_m3, 2, "m³")}`,
        `suffers ${withUnit(residual.suffers_m2, 2, "m²")}`,
      ]
    : [];
  return [`Frame ${number}`, time, ...review, ...edited, ...residuals];
}

/** What each frame causes and suffers, with the largest of all; null where it is not known. */
function scaledResiduals({ residuals, hull }) {
  if (!residuals) return null;
  const most = (key) => Math.max(...residuals.frames.map((each) => each[key] ?? 0), 1e-9);
  const mostCauses = most("causes_m3");
  const mostSuffers = most("suffers_m2");
  const shares = (each) => ({
    ...each,
    causes: (each.causes_m3 ?? 0) / mostCauses,
    suffers: (each.suffers_m2 ?? 0) / mostSuffers,
  });
  return {
    isOld: residuals.revision !== hull?.revision,
    of: new Map(residuals.frames.map((each) => [each.number, shares(each)])),
  };
}

function showBars(cell, residual) {
  const [causes, suffers] = cell.querySelectorAll(".bars i");
  causes.style.setProperty("--share", residual?.causes ?? 0);
  suffers.style.setProperty("--share", residual?.suffers ?? 0);
}
