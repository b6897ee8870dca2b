// The passes above the row of frames: plots to read and to move by, and what they tell at a time.

import { CoursePlots } from "./course-plots.js";
import { Latest } from "./latest.js";
import { keptTogether, withUnit } from "./numbers.js";
import { PassAxis } from "./pass-axis.js";
import { valueAt } from "./quantities.js";
import { getJson } from "./server.js";

const KEY = "radarhull.plots";

export class Timeline {
  #parts;
  #plots;
  #axis = null;
  #state = null;
  #source = "";
  #frames = [];
  #wished = null;
  #wish;

  /** Show passes in `parts`, and go to frames through the asynchronous `show(number)`. */
  constructor(parts, show) {
    this.#parts = parts;
    this.#wish = new Latest(show);
    this.#plots = new CoursePlots(parts.plots, {
      point: (place, left) => this.#read(place, left),
      wish: (place) => this.#go(place),
      end: () => this.#settle(),
    });
    parts.toggle.addEventListener("click", () => this.#open(parts.course.hidden));
    this.#isOpen = remembered();
    this.#open(this.#isOpen, { isAsked: false });
  }

  #isOpen;

  update(state) {
    this.#state = state;
    const source = `${state.run}/${state.source.name}`;
    if (source !== this.#source) this.#fetch(source);
    if (this.#axis === null) return;
    if (this.#axis.isOfFrames) this.#takePasses(passesOfFrames(state), true);
    this.#mark();
  }

  async #fetch(source) {
    this.#source = source;
    const { passes } = await getJson("/api/course").catch(() => ({ passes: null }));
    // The next state asks again.
    if (passes === null) this.#source = "";
    else if (source === this.#source) {
      const isKnown = passes.length > 0;
      this.#takePasses(isKnown ? passes : passesOfFrames(this.#state), !isKnown);
    }
  }

  #takePasses(passes, isOfFrames) {
    const samples = passes.reduce((sum, pass) => sum + pass.time_s.length, 0);
    if (isOfFrames && this.#axis?.samples === samples) return;
    this.#axis = Object.assign(new PassAxis(passes), { isOfFrames, samples });
    this.#parts.toggle.disabled = passes.length === 0;
    this.#open(this.#isOpen, { isAsked: false });
    if (passes.length > 0) this.#plots.show(this.#axis);
    this.#mark();
    this.#read(null);
  }

  #open(isOpen, { isAsked = true } = {}) {
    if (isAsked) remember((this.#isOpen = isOpen));
    const { course, toggle } = this.#parts;
    // Before the passes are known their room is kept, so that nothing moves when they come.
    course.hidden = !isOpen || this.#axis?.spans.length === 0;
    toggle.ariaPressed = String(!course.hidden);
  }

  #mark() {
    this.#frames = this.#axis.frames(this.#state.times_s, this.#state.labels);
    this.#plots.setFrames(this.#frames, this.#wished ?? this.#state.shown);
    this.#read(null);
  }

  #go(place) {
    const number = this.#axis.nearest(place, this.#frames);
    if (number === null || number === (this.#wished ?? this.#state.shown)) return;
    // The mark follows the pointer at once, the frame as soon as it can.
    this.#wished = number;
    this.#plots.setFrames(this.#frames, number);
    this.#wish.ask(number);
  }

  #settle() {
    this.#wished = null;
  }

  /** Tell the values at a place, or at the frame on show. */
  #read(place, left = 0) {
    const { readout, note } = this.#parts;
    note.hidden = true;
    const where = place ?? this.#frames[this.#state.shown - 1] ?? null;
    if (this.#axis === null || where === null || this.#axis.spans.length === 0) {
      readout.replaceChildren();
      return;
    }
    const { pass, time } = this.#axis.at(where);
    const number = place === null ? this.#state.shown : this.#axis.nearest(where, this.#frames);
    const title = [pass.label, withUnit(time, 1, "s")].filter(Boolean).join(", ");
    readout.replaceChildren(
      row("", title, number === null ? "" : `frame ${number}`, "title"),
      ...this.#plots.quantities.map((quantity) =>
        row(quantity.key, quantity.name, reading(quantity, valueAt(pass, quantity, time))),
      ),
      ...(pass.intervals.length > 0 ? [verdictRow(intervalAt(pass, time))] : []),
    );
    if (place !== null) this.#explain(pass, intervalAt(pass, time), left);
  }

  /** Say beside the pointer why an interval is not used as it was wanted. */
  #explain({ judged }, interval, left) {
    const { note, plots } = this.#parts;
    if (!interval || interval.verdict === "accepted") return;
    note.textContent = keptTogether(`${interval.verdict}: ${interval.reason}. ${judged}`);
    note.hidden = false;
    const most = plots.clientWidth - note.offsetWidth;
    note.style.left = `${plots.offsetLeft + Math.min(Math.max(left - note.offsetWidth / 2, 0), most)}px`;
  }
}

function intervalAt(pass, time) {
  return pass.intervals
    .filter((each) => each.start_s <= time && time <= each.stop_s)
    .sort((a, b) => Math.abs(a.middle_s - time) - Math.abs(b.middle_s - time))[0];
}

function reading({ decimals, unit }, value) {
  if (value === null) return "–";
  return unit === "°" ? withUnit(value, decimals, "°").replace("\u202f", "") : withUnit(value, decimals, unit);
}

function verdictRow(interval) {
  if (interval === undefined) return row("none", "Interval", "none");
  return row(interval.verdict, "Interval", interval.verdict);
}

function row(key, name, value, className = "") {
  const made = document.createElement("div");
  made.className = className;
  const [term, text] = [document.createElement("dt"), document.createElement("dd")];
  if (key) {
    const swatch = document.createElement("i");
    swatch.className = `key ${key.replaceAll("_", "-")}`;
    term.append(swatch);
  }
  term.append(name);
  text.textContent = value;
  made.append(term, text);
  return made;
}

/** What the frames themselves tell of their passes, where no track is known. */
function passesOfFrames({ times_s: times, labels, sights }) {
  if (!sights) return [];
  const passes = new Map();
  sights.forEach(([x, y, z], index) => {
    const label = labels[index];
    if (!passes.has(label)) passes.set(label, { label, judged: "", time_s: [], theta_deg: [], phi_deg: [], intervals: [] });
    const pass = passes.get(label);
    // Frames of other sensors may come between; the axis needs times that grow.
    if (times[index] <= pass.time_s.at(-1)) return;
    pass.time_s.push(times[index]);
    pass.theta_deg.push(degrees(Math.asin(Math.min(Math.max(z, -1), 1))));
    pass.phi_deg.push(degrees(Math.atan2(x, y)));
  });
  return [...passes.values()].filter((pass) => pass.time_s.length > 1);
}

const degrees = (radians) => (radians * 180) / Math.PI;

function remembered() {
  try {
    return localStorage.getItem(KEY) !== "closed";
  } catch {
    return true;
  }
}

function remember(isOpen) {
  try {
    localStorage.setItem(KEY, isOpen ? "open" : "closed");
  } catch {
    // A browser that keeps nothing still opens and closes.
  }
}
