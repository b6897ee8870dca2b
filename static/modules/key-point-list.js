// The list of key points: which is active, where each lies, and how well its marks agree.

import { part } from "./elements.js";
import { fixed, withUnit } from "./numbers.js";

export class KeyPointList {
  #points;
  #go;
  #renaming = null;
  /** The ends of the length that was added last. */
  #added = "";

  /** Show `points`, and call `go(number)` to see a frame. */
  constructor(points, go) {
    this.#points = points;
    this.#go = go;
    part("key-point-new").addEventListener("click", () => points.begin());
    part("key-point-undo").addEventListener("click", () => points.undo());
    part("key-point-redo").addEventListener("click", () => points.redo());
    part("key-point-sigma").addEventListener("change", (event) => this.#setSigma(event.target));
    for (const id of ["key-point-from", "key-point-to"]) {
      part(id).addEventListener("change", () => this.#measure());
    }
    part("key-point-measure").addEventListener("click", () => this.#add());
  }

  /** Stand first while somebody marks. */
  setMarking(isMarking) {
    part("key-points").classList.toggle("marking", isMarking);
  }

  show() {
    const { points, book, active } = this.#points;
    part("key-point-undo").disabled = !book.can_undo;
    part("key-point-redo").disabled = !book.can_redo;
    const sigma = part("key-point-sigma");
    if (document.activeElement !== sigma) sigma.value = String(book.sigma_px);
    this.#offerLength(points.filter(({ position_m: position }) => position !== null));
    // Somebody types a name.
    if (this.#renaming !== null) return;
    const isNew = !points.some(({ name }) => name === active);
    const rows = isNew ? [...points, { name: active, marks: [], complaint: "" }] : points;
    part("key-point-list").replaceChildren(...rows.map((point) => this.#row(point)));
  }

  #row(point) {
    const isActive = point.name === this.#points.active;
    const row = made("li", `key-point${isActive ? " active" : ""}`);
    row.dataset.name = point.name;
    row.append(this.#head(point, isActive), ...placeLines(point));
    if (point.marks.length > 0) row.append(this.#marks(point));
    return row;
  }

  #head(point, isActive) {
    const head = made("div", "head");
    const choose = button(point.name, "choose", `Mark ${point.name}`, () => this.#points.choose(point.name));
    choose.ariaPressed = String(isActive);
    const rename = button("Rename", "quiet", `Rename ${point.name}`, () => this.#rename(point.name, choose));
    head.append(choose, rename);
    if (point.marks.length > 0) {
      head.append(button("Delete", "quiet", `Delete ${point.name}`, () => this.#points.removePoint(point.name)));
    }
    return head;
  }

  /** One button for each mark: its frame, and how far it lies from where the point is projected. */
  #marks({ name, marks }) {
    const list = made("div", "marks");
    const count = made("span", "", marks.length === 1 ? "1 mark: frame" : `${marks.length} marks: frames`);
    list.append(count, ...marks.map((mark) => {
      const { frame, residual_px: residual, is_suspicious: isSuspicious } = mark;
      const off = residual === null ? "" : `, ${withUnit(residual, 1, "px")} off`;
      const chip = button(String(frame), isSuspicious ? "bad" : "", `Go to frame ${frame}${off}`, () => {
        this.#points.choose(name);
        this.#go(frame);
      });
      if (frame === this.#points.frame) chip.ariaCurrent = "true";
      return chip;
    }));
    return list;
  }

  #rename(name, place) {
    const input = made("input", "choose");
    let isKept = true;
    Object.assign(input, { value: name, maxLength: 40, ariaLabel: `Name of ${name}` });
    this.#renaming = name;
    const end = () => {
      if (this.#renaming === null) return;
      this.#renaming = null;
      if (isKept) this.#points.rename(name, input.value);
      this.show();
    };
    input.addEventListener("blur", end);
    input.addEventListener("keydown", (event) => {
      if (!["Enter", "Escape"].includes(event.key)) return;
      event.preventDefault();
      event.stopPropagation();
      isKept = event.key === "Enter";
      end();
      part("frame-canvas").focus({ preventScroll: true });
    });
    place.replaceWith(input);
    input.select();
    input.focus();
  }

  #setSigma(input) {
    if (input.checkValidity() && input.value !== "") this.#points.setSigma(Number(input.value));
    else input.value = String(this.#points.book.sigma_px);
  }

  #offerLength(placed) {
    part("key-point-length").hidden = placed.length < 2;
    if (placed.length < 2) return;
    const names = placed.map(({ name }) => name);
    for (const [first, id] of ["key-point-from", "key-point-to"].entries()) {
      const select = part(id);
      const before = select.value;
      select.replaceChildren(...names.map((name) => new Option(name, name)));
      select.value = names.includes(before) ? before : names[first];
    }
    this.#measure();
  }

  async #add() {
    const ends = this.#ends();
    if (!(await this.#points.measure(...ends))) return;
    this.#added = ends.join("/");
    this.#measure();
  }

  #ends() {
    return ["key-point-from", "key-point-to"].map((id) => part(id).value);
  }

  async #measure() {
    const [first, second] = this.#ends();
    const output = part("key-point-value");
    const isAdded = this.#added === [first, second].join("/");
    part("key-point-measure").disabled = first === second || isAdded;
    part("key-point-measure").textContent = isAdded ? "Added to measurements" : "Add to measurements";
    if (first === second) {
      output.textContent = "Choose two different points.";
      return;
    }
    const text = await this.#points.length(first, second).then(lengthText, (error) => [error.message]);
    if (this.#ends().join("/") === [first, second].join("/")) output.replaceChildren(...text);
  }
}

function lengthText({ value_m: value, low_m: low, high_m: high, direction }) {
  const interval = ` [${fixed(low, 2)}, ${fixed(high, 2)}]`;
  const way = made("small", "", `along ${direction.map((each) => fixed(each, 3)).join(", ")}; 95 % from the marks`);
  return [made("b", "", withUnit(value, 2, "m")), interval, way];
}

/** Position with its standard errors and the worst residual, or why there is none. */
function placeLines({ marks, position_m: position, sigma_m: sigma, complaint }) {
  if (marks.length === 0) {
    return [made("p", "quiet-line", "Choose Point (J), then click its corner in the picture.")];
  }
  if (!position) {
    const hint = "Other frames show it on the dashed line.";
    return [made("p", "open", complaint), ...(marks.length === 1 ? [made("p", "quiet-line", hint)] : [])];
  }
  const table = made("p", "place");
  table.append(...["x", "y", "z"].map((axis, index) => {
    const cell = made("span", "");
    cell.append(
      made("i", axis, axis), ` ${withUnit(position[index], 2, "m")}`,
      made("small", "", `± ${fixed(sigma[index], 2)}`),
    );
    return cell;
  }));
  const worst = marks.reduce((one, other) => (one.residual_px >= other.residual_px ? one : other));
  const text = `worst residual ${withUnit(worst.residual_px, 1, "px")}, frame ${worst.frame}`;
  const isBad = worst.is_suspicious;
  const line = made("p", isBad ? "bad" : "quiet-line", isBad ? `${text}: is it the same corner?` : text);
  return [table, line];
}

function button(text, className, title, act) {
  const element = made("button", className, text);
  Object.assign(element, { type: "button", title });
  element.addEventListener("click", act);
  return element;
}

function made(name, className, text = "") {
  const element = document.createElement(name);
  element.className = className;
  element.textContent = text;
  return element;
}
