// Key points: corners marked in several frames, where they lie, and the one being marked.

import { KeyPointList } from "./key-point-list.js";
import { Latest } from "./latest.js";
import { getJson, send } from "./server.js";

const PATH = "/api/key_points";

export class KeyPoints {
  points = [];
  book = { revision: -1, can_undo: false, can_redo: false, sigma_px: 1 };
  /** Name of the point that a click marks; one that is not among the points begins with it. */
  active = "point 1";
  /** Whether the tool that marks is in hand. */
  isMarking = false;
  /** A mark that is being placed, or waits for the server: {name, frame, row, column}. */
  #draft = null;
  #expected = [];
  #frame = null;
  #source = "";
  #seen = "";
  #chain = Promise.resolve();
  #list;
  #hooks;
  #asking = new Latest(() => this.#ask(), 30);

  /** Call `hooks.redraw()`, `.complain(sentence)`, `.go(number)` for a frame, `.open()` for the list. */
  constructor(hooks) {
    this.#hooks = hooks;
    this.#list = new KeyPointList(this, hooks.go);
  }

  /** Number of the frame on show, null without one. */
  get frame() {
    return this.#frame;
  }

  /** Follow the server's state. */
  update(state) {
    if (!state.key_points) return;
    if (state.source.key !== this.#source) {
      this.#source = state.source.key;
      this.book = { ...this.book, revision: -1 };
      this.active = "point 1";
    }
    this.#take(state);
  }

  /** Follow the frame on show. */
  follow(frame) {
    const number = frame?.number ?? null;
    if (number === this.#frame) return;
    this.#frame = number;
    this.#draft = null;
    this.#expected = [];
    this.#show();
  }

  /** The tool that marks was taken up or laid down. */
  setMarking(isMarking) {
    this.isMarking = isMarking;
    this.#list.setMarking(isMarking);
    if (isMarking) this.#hooks.open();
    this.#hooks.redraw();
  }

  choose(name) {
    this.active = name;
    this.#show();
  }

  /** Begin another point: the next click marks it. */
  begin() {
    this.choose(freeName(this.points));
  }

  /** The mark of a point in the frame on show, null for none. */
  markOf(name) {
    return this.marks().find((mark) => mark.name === name) ?? null;
  }

  /** All marks in the frame on show, each with its point's name; the one being placed as it is now. */
  marks() {
    const kept = this.points.flatMap(({ name, marks }) =>
      marks.filter(({ frame }) => frame === this.#frame).map((mark) => ({ ...mark, name })));
    const draft = this.#draft?.frame === this.#frame ? this.#draft : null;
    return draft ? [...kept.filter(({ name }) => name !== draft.name), draft] : kept;
  }

  /** Where the points should be seen in the frame on show. */
  expected() {
    return this.#expected;
  }

  /** Place the active point's mark without keeping it; null takes that back. */
  draft(place) {
    const [row, column] = place ?? [];
    this.#draft = place && { name: this.active, frame: this.#frame, row, column };
    this.#hooks.redraw();
  }

  /** Keep the mark that is being placed. */
  keep() {
    const mark = this.#draft;
    if (mark) return this.#order(() => send("PUT", `${PATH}/mark`, mark));
    return this.#chain;
  }

  /** Take the active point's mark in the frame on show away. */
  removeMark() {
    const [name, frame] = [this.active, this.#frame];
    if (!this.markOf(name)) return this.#chain;
    const query = new URLSearchParams({ name, frame });
    return this.#order(() => send("DELETE", `${PATH}/mark?${query}`));
  }

  removePoint(name) {
    if (name === this.active) {
      const others = this.points.filter((point) => point.name !== name);
      this.active = others.at(-1)?.name ?? name;
    }
    return this.#order(() => send("DELETE", `${PATH}/point?${new URLSearchParams({ name })}`));
  }

  rename(name, text) {
    const newName = text.split(/\s+/).filter(Boolean).join(" ");
    if (newName === name) return this.#show();
    const isActive = name === this.active;
    if (!this.points.some((point) => point.name === name)) {
      if (newName) this.active = newName;
      return this.#show();
    }
    return this.#order(async () => {
      const answer = await send("PUT", `${PATH}/name`, { name, new_name: newName });
      if (isActive) this.active = newName;
      return answer;
    });
  }

  setSigma(pixels) {
    return this.#order(() => send("PUT", `${PATH}/sigma`, { sigma_px: pixels }));
  }

  undo() {
    if (this.book.can_undo) this.#order(() => send("POST", `${PATH}/undo`));
  }

  redo() {
    if (this.book.can_redo) this.#order(() => send("POST", `${PATH}/redo`));
  }

  /** Fetch the length between two points. */
  length(first, second) {
    return getJson(`${PATH}/length?${new URLSearchParams({ first, second })}`);
  }

  /** Keep the length between two points among the measurements; false where that is refused. */
  async measure(first, second) {
    const [start, end] = [first, second].map((name) => ({ kind: "key point", name }));
    const spec = { kind: "length", name: `${first} – ${second}`, start, end };
    try {
      await send("POST", "/api/measurements", { spec });
      return true;
    } catch (error) {
      this.#hooks.complain(error.message);
      return false;
    }
  }

  /** Send one order after the other, and show what came of it. */
  #order(work) {
    this.#chain = this.#chain.then(async () => {
      try {
        this.#take(await work());
      } catch (error) {
        this.#hooks.complain(error.message);
      }
      this.#draft = null;
      this.#show();
    });
    return this.#chain;
  }

  #take({ key_points: points, key_points_book: book }) {
    // The answer to an order may arrive after the news of what followed it.
    if (book.revision < this.book.revision) return;
    Object.assign(this, { points, book });
    this.#show();
  }

  #show() {
    const { points, book, active } = this;
    const seen = JSON.stringify([points, book, active, this.#frame]);
    this.#hooks.redraw();
    if (seen !== this.#seen) {
      this.#seen = seen;
      this.#list.show();
      if (this.#frame !== null) this.#asking.ask();
    }
  }

  async #ask() {
    const number = this.#frame;
    if (number === null) return;
    const answer = await getJson(`${PATH}/expected/${number}`).catch(() => null);
    if (answer === null || number !== this.#frame) return;
    this.#expected = answer.expected;
    this.#hooks.redraw();
  }
}

/** "point 3", the first that no point is called yet. */
function freeName(points) {
  const taken = new Set(points.map(({ name }) => name));
  let number = 1;
  while (taken.has(`point ${number}`)) number += 1;
  return `point ${number}`;
}
