// The book of measurements in its tab: the list, what adds to it, its way back, files and intervals.

import { confirmed } from "./confirm.js";
import { all, part } from "./elements.js";
import { MeasurementRow } from "./measurement-row.js";
import { send, upload } from "./server.js";

const PATH = "/api/measurements";
const LARGEST_BYTES = 16 * 2 ** 20;
const AXES = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };
const LINES = ["l₁", "l₂", "l₃"];

export class Measurements {
  #state = null;
  #facts = null;
  #source = "";
  #rows = new Map();
  #open = new Set();
  #frame = "target";
  #openTab;

  /** `open()` brings the tab to the front. */
  constructor({ open }) {
    this.#openTab = open;
    part("book-undo").addEventListener("click", () => this.#order("POST", "/undo"));
    part("book-redo").addEventListener("click", () => this.#order("POST", "/redo"));
    part("book-clear").addEventListener("click", () => this.#order("POST", "/clear"));
    part("book-import").addEventListener("click", () => part("measurements-file").click());
    part("measurements-file").addEventListener("change", () => this.#import());
    part("book-frame").addEventListener("change", () => {
      this.#frame = part("book-frame").value;
      this.#show();
    });
    part("book-intervals-button").addEventListener("click", () => {
      const action = this.#facts.intervals.is_running ? "cancel" : "start";
      this.#order("PUT", "/intervals", { action });
    });
    this.#bindMenu();
  }

  update(state) {
    const { measurements: facts, source } = state;
    this.#state = state;
    if (!facts) return;
    if (source.key !== this.#source) this.#facts = null;
    this.#source = source.key;
    this.#take(facts);
  }

  openMenu() {
    this.#openTab();
    if (!part("book").hidden) part("book-menu").showPopover();
  }

  #bindMenu() {
    const menu = part("book-menu");
    menu.addEventListener("toggle", (event) => {
      if (event.newState !== "open") return;
      this.#place(menu);
      menu.querySelector("button").focus();
    });
    for (const button of menu.querySelectorAll("[data-measure]")) {
      button.addEventListener("click", () => this.#add([{ kind: button.dataset.measure }]));
    }
    for (const button of menu.querySelectorAll("[data-section]")) {
      const axis = button.dataset.section;
      button.addEventListener("click", () => this.#add([
        { kind: "section", ...this.#named(`section across ${axis}`), normal: AXES[axis] },
      ]));
    }
    for (const button of menu.querySelectorAll("[data-pair]")) {
      button.addEventListener("click", () => {
        const [first, second] = [part("measure-first").value, part("measure-second").value];
        const kind = button.dataset.pair;
        const name = kind === "scale factor" ? `${first} / ${second}` : `angle of ${first}, ${second}`;
        this.#add([{ kind, ...this.#named(name), first, second }]);
      });
    }
    part("measure-lines").addEventListener("click", () => this.#add(this.#lines()));
  }

  /** Lay the menu under its button, within the window. */
  #place(menu) {
    const button = part("book-add").getBoundingClientRect();
    const top = Math.min(button.bottom + 4, innerHeight - menu.offsetHeight - 8);
    menu.style.inset = `${top}px ${innerWidth - button.right}px auto auto`;
  }

  /** A name if it is free; without one the server finds one. */
  #named(name) {
    const isTaken = this.#facts.items.some((item) => item.name === name);
    return isTaken || name.length > 200 ? {} : { name };
  }

  /** Three lines between the ends of the hull's principal axes. */
  #lines() {
    const { hull, window_m: reach } = this.#state;
    const end = (toward) => ({ kind: "part end", near_m: [0, 0, 0], toward, reach_m: reach });
    return hull.lines.map(({ direction }, index) => ({
      kind: "line feature",
      ...this.#named(LINES[index]),
      start: end(direction.map((component) => -component)),
      end: end(direction),
    }));
  }

  #add(specs) {
    part("book-menu").hidePopover();
    return this.#order("POST", "", { specs });
  }

  async #import() {
    const field = part("measurements-file");
    const [file] = field.files;
    field.value = "";
    if (!file) return;
    const query = new URLSearchParams({ name: file.name });
    await this.#try(async () => {
      if (file.size > LARGEST_BYTES) throw new Error(`${file.name} is larger than 16 MB.`);
      return upload(`${PATH}/import?${query}`, file, () => {}).done;
    });
  }

  #order(method, path, body) {
    return this.#try(() => send(method, `${PATH}${path}`, body));
  }

  /** Do what gives the server's facts, and show them, or why it came to nothing. */
  async #try(act) {
    this.#complain("");
    try {
      this.#take(await act());
      return true;
    } catch (error) {
      this.#complain(error.message);
      return false;
    }
  }

  #complain(sentence) {
    part("book-complaint").textContent = sentence;
    part("book-complaint").hidden = sentence === "";
  }

  async #rename(name, rename) {
    if (this.#open.has(name)) this.#open.add(rename);
    // What is renamed keeps its row, and whoever stands on it.
    const row = this.#rows.get(name);
    this.#rows.delete(name);
    this.#rows.set(rename, row);
    if (await this.#order("PUT", "", { name, rename })) return;
    this.#rows.delete(rename);
    this.#rows.set(name, row);
    this.#show();
  }

  async #remove({ name }) {
    const along = dependents(name, this.#facts.items);
    if (along.length > 0) {
      const are = along.length === 1 ? "is" : "are";
      const isSure = await confirmed({
        title: `Delete ${name}?`,
        text: `${along.join(", ")} ${are} computed from it and would be deleted too. Undo brings all of it back.`,
        action: "Delete all of it",
      });
      if (!isSure) return;
    }
    await this.#order("DELETE", `?${new URLSearchParams({ name, along: String(along.length > 0) })}`);
  }

  /** Take facts, unless later ones are here already. */
  #take(facts) {
    if (this.#facts !== null && facts.serial < this.#facts.serial) return;
    this.#facts = facts;
    this.#show();
  }

  #show() {
    const facts = this.#facts;
    const { hull } = this.#state;
    part("book").hidden = hull === null && facts.items.length === 0;
    part("book-empty").hidden = facts.items.length > 0;
    part("book-undo").disabled = !facts.can_undo;
    part("book-redo").disabled = !facts.can_redo;
    part("book-clear").hidden = facts.items.length === 0;
    this.#offerFrames(facts);
    this.#offerPairs(facts);
    part("measure-lines").disabled = !hull || hull.lines.length === 0;
    this.#showRows(facts, hull);
    this.#showIntervals(facts);
    for (const ending of ["csv", "json"]) {
      part(`book-${ending}`).href = `${PATH}.${ending}?frame=${this.#frame}`;
    }
  }

  #showRows({ items }, hull) {
    const names = new Set(items.map(({ name }) => name));
    for (const name of this.#rows.keys()) if (!names.has(name)) this.#rows.delete(name);
    const elements = items.map((item) => {
      const row = this.#rows.get(item.name) ?? new MeasurementRow(this.#hooks);
      this.#rows.set(item.name, row);
      row.update(item, {
        frame: this.#frame,
        isOpen: this.#open.has(item.name),
        isOld: item.revision !== null && item.revision !== hull?.revision,
      });
      return row.element;
    });
    const list = part("book-rows");
    const isSame = list.children.length === elements.length &&
      elements.every((element, index) => list.children[index] === element);
    if (!isSame) list.replaceChildren(...elements);
  }

  #hooks = {
    toggle: (name) => {
      if (!this.#open.delete(name)) this.#open.add(name);
      this.#show();
    },
    rename: (name, rename) => this.#rename(name, rename),
    note: (name, note) => this.#order("PUT", "", { name, note }),
    hide: (name, isHidden) => this.#order("PUT", "", { name, is_hidden: isHidden }),
    remove: (item) => this.#remove(item),
  };

  #offerFrames({ frames }) {
    const select = part("book-frame");
    select.hidden = frames.length < 2;
    if (!frames.includes(this.#frame)) this.#frame = "target";
    if (select.children.length === frames.length) return;
    select.replaceChildren(...frames.map((name) => new Option(name, name)));
    select.value = this.#frame;
  }

  #offerPairs({ items }) {
    const names = items.map(({ name }) => name);
    const selects = ["measure-first", "measure-second"].map(part);
    const known = [...selects[0].options].map((option) => option.value);
    if (known.join("\n") !== names.join("\n")) {
      for (const select of selects) {
        const { value } = select;
        select.disabled = names.length === 0;
        select.replaceChildren(...names.map((name) => new Option(name, name)));
        select.value = names.includes(value) ? value : names[0] ?? "";
      }
      // Of one and the same nothing is computed.
      const other = names.find((name) => name !== selects[0].value);
      if (selects[0].value === selects[1].value && other) selects[1].value = other;
    }
    for (const button of all("[data-pair]")) button.disabled = names.length === 0;
  }

  #showIntervals({ intervals, items, hull: found }) {
    const { hull, status } = this.#state;
    const { is_running: isRunning, done, total, complaint } = intervals;
    const isMissing = found?.revision !== hull?.revision || items.some((item) => item.value !== null && !item.interval_note);
    const bar = part("book-intervals-bar");
    part("book-intervals").hidden = !hull || hull.is_empty || !(isRunning || isMissing);
    bar.hidden = !isRunning;
    bar.value = total > 0 ? done / total : 0;
    part("book-intervals-button").textContent = isRunning ? "Cancel" : "Compute now";
    part("book-intervals-button").hidden = !isRunning && (hull?.is_preview || status === "playing" || complaint !== "");
    part("book-intervals-text").textContent = isRunning
      ? `Intervals: ${done} of ${total || "…"} hulls`
      : complaint || waitingText(hull, status);
  }
}

function waitingText(hull, status) {
  if (hull?.is_preview) return "An outline is being tried; numbers follow once it is kept or given up.";
  if (status === "playing") return "Intervals follow once no frame comes any more, or playback pauses.";
  return "Intervals come once nothing has changed for a while.";
}

/** The names of all that is computed from a measurement, and from that in turn. */
function dependents(name, items) {
  const found = [name];
  for (const one of found) {
    const more = items.filter((item) => item.refers_to.includes(one) && !found.includes(item.name));
    found.push(...more.map((item) => item.name));
  }
  return found.slice(1);
}
