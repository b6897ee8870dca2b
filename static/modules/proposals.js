// The tools that propose an outline: their settings, what they found, apply or discard.

import { Latest } from "./latest.js";
import { fixed } from "./numbers.js";
import { propose } from "./server.js";

const FRAME = { before: -1, after: 1 };

/** Each tool: its name on the server, its label and keys, and settings [key, label, low, high, step, at first, unit]. */
const TOOLS = [
  {
    name: "threshold",
    label: "Threshold",
    keys: "T",
    hint: "Detects the target anew.",
    settings: [
      ["a1", "Censoring a₁", 1, 10, 0.25, 3, ""],
      ["a2", "Detection a₂", 1, 20, 0.25, 5, ""],
      ["closing_px", "Closing", 0, 15, 1, 5, "px"],
    ],
  },
  {
    name: "grow",
    label: "Fill a region",
    keys: "F",
    hint: "Click the picture where the target is.",
    settings: [["tolerance_db", "Tolerance", 1, 30, 0.5, 8, "dB"]],
    needsSeed: true,
  },
  {
    name: "snap",
    label: "Snap to edge",
    keys: "S",
    hint: "Moves vertices to the strongest edge in reach.",
    settings: [["reach_px", "Reach", 1, 20, 0.5, 5, "px"]],
  },
  {
    name: "smooth",
    label: "Smooth",
    hint: "Takes fine wiggles out of the outline.",
    settings: [["strength_px", "Strength", 0.5, 10, 0.5, 1.5, "px"]],
  },
  {
    name: "simplify",
    label: "Simplify",
    hint: "Takes out vertices that move the outline by less.",
    settings: [["tolerance_px", "Tolerance", 0.05, 5, 0.05, 0.5, "px"]],
  },
  { name: "fill holes", label: "Fill holes", hint: "Takes the holes out of the outline.", settings: [] },
  { name: "grabcut", label: "GrabCut", hint: "Parts bright from dark, beginning at the outline.", settings: [], sensor: "optical" },
  { name: "copy", key: "copy previous", label: "Copy previous", keys: "C", hint: "The outline of the frame before.", settings: [], from: "before" },
  { name: "copy", key: "copy next", label: "Copy next", keys: "Shift C", hint: "The outline of the frame after.", settings: [], from: "after" },
  { name: "interpolate", label: "Interpolate", hint: "Between the frames before and after.", settings: [], from: "both" },
  { name: "reprojection", label: "From the hull", keys: "U", hint: "The hull as this frame sees it.", settings: [] },
];

export class Proposals {
  #parts;
  #session;
  #hooks;
  #values = new Map();
  #tool = null;
  #seed = null;
  #found = null;
  #offered = [];
  #asking = new Latest(() => this.#ask(), 30);

  /** Propose for `session`; `hooks.show(rings or null)`, `hooks.frames()`, `hooks.open()`, `hooks.seeding(bool)`, `hooks.set()` after a setting. */
  constructor(parts, session, hooks) {
    this.#parts = parts;
    this.#session = session;
    this.#hooks = hooks;
    parts.apply.addEventListener("click", () => this.apply());
    parts.discard.addEventListener("click", () => this.discard());
  }

  /** Offer the tools that the server has. */
  offer(known) {
    this.#offered = TOOLS.filter(({ name }) => known.includes(name));
    this.#parts.list.replaceChildren(...this.#offered.map((tool) => this.#button(tool)));
  }

  /** Offer only what suits the frame on show. */
  update() {
    const sensor = this.#session.frame?.sensor;
    for (const [index, tool] of this.#offered.entries()) {
      this.#parts.list.children[index].hidden = !suits(tool, sensor);
    }
  }

  /** Begin the threshold's settings with those by which all frames were detected. */
  beginWith(extraction) {
    const tool = TOOLS.find(({ name }) => name === "threshold");
    for (const setting of tool.settings) setting[5] = extraction[setting[0]] ?? setting[5];
  }

  /** What the threshold is set to, whether its tool is open or not. */
  thresholdSettings() {
    const tool = TOOLS.find(({ name }) => name === "threshold");
    return Object.fromEntries(tool.settings.map((setting) => [setting[0], this.#value(tool, setting)]));
  }

  get isOpen() {
    return this.#tool !== null;
  }

  /** Choose a tool by its key and ask for what it proposes. */
  choose(key) {
    if (!this.#session.isEditable) return;
    const tool = this.#offered.find((each) => keyOf(each) === key);
    if (!tool || !suits(tool, this.#session.frame.sensor)) return;
    const isSameTool = tool === this.#tool;
    this.#forget();
    this.#tool = tool;
    this.#hooks.open();
    this.#hooks.seeding(Boolean(tool.needsSeed));
    if (!isSameTool) this.#showSettings();
    this.#show();
    if (!tool.needsSeed) this.#asking.ask();
  }

  seed(row, column) {
    this.#seed = { row, column };
    if (this.#tool?.needsSeed) this.#asking.ask();
  }

  /** Keep what is proposed; false where nothing is. */
  apply() {
    if (!this.#found) return false;
    const { rings, claim } = this.#found;
    const { name } = this.#tool;
    this.#end();
    this.#session.commit(rings, name, claim);
    return true;
  }

  /** Give the proposal up; false where there is none. */
  discard() {
    if (!this.isOpen) return false;
    this.#end();
    this.#session.withdraw();
    return true;
  }

  async #ask() {
    const tool = this.#tool;
    const { frame, component, rings } = this.#session;
    const parameters = this.#parameters(tool, frame.number);
    if (parameters === null) return;
    try {
      const found = await propose(frame.number, component, tool.name, parameters, rings);
      if (component !== this.#session.component) return;
      if (tool !== this.#tool || frame.number !== this.#session.frame?.number) return;
      this.#found = found;
      this.#session.preview(found.rings, tool.name, found.claim);
      this.#show();
    } catch (error) {
      this.#found = null;
      if (tool === this.#tool) this.#show(error.message);
    }
  }

  #parameters(tool, number) {
    const values = Object.fromEntries(tool.settings.map((setting) => [setting[0], this.#value(tool, setting)]));
    if (tool.needsSeed) return this.#seed && { ...values, ...this.#seed };
    if (tool.from === "both") return { from: [number - 1, number + 1] };
    return tool.from ? { from: number + FRAME[tool.from] } : values;
  }

  #value(tool, [key, , , , , first]) {
    return this.#values.get(`${tool.name}/${key}`) ?? first;
  }

  #forget() {
    this.#found = null;
    this.#seed = null;
    this.#hooks.show(null);
  }

  #end() {
    this.#forget();
    this.#tool = null;
    this.#hooks.seeding(false);
    this.#show();
  }

  #show(complaint = "") {
    const { list, form, hint, apply, discard, all, complaint: place } = this.#parts;
    for (const button of list.children) {
      button.ariaPressed = String(button.dataset.key === (this.#tool && keyOf(this.#tool)));
    }
    form.hidden = this.#tool === null;
    all.hidden = this.#tool?.name !== "threshold";
    hint.textContent = [this.#tool?.hint, this.#found && foundText(this.#found)].filter(Boolean).join(" ");
    place.textContent = complaint;
    place.hidden = complaint === "";
    apply.disabled = this.#found === null;
    discard.disabled = this.#tool === null;
    this.#hooks.show(this.#found?.rings ?? null);
  }

  #button(tool) {
    const button = document.createElement("button");
    button.type = "button";
    button.dataset.key = keyOf(tool);
    button.textContent = tool.label;
    button.title = [tool.hint, tool.keys && `(${tool.keys})`].filter(Boolean).join(" ");
    button.ariaPressed = "false";
    button.addEventListener("click", () => this.choose(keyOf(tool)));
    return button;
  }

  #showSettings() {
    const tool = this.#tool;
    this.#parts.settings.replaceChildren(...tool.settings.map((setting) => this.#slider(tool, setting)));
  }

  #slider(tool, setting) {
    const [key, text, low, high, step, , unit] = setting;
    const label = document.createElement("label");
    const input = document.createElement("input");
    const output = document.createElement("output");
    const decimals = (String(step).split(".")[1] ?? "").length;
    const tell = (value) => {
      output.textContent = unit ? `${fixed(value, decimals)}\u202f${unit}` : fixed(value, decimals);
    };
    label.className = "slider";
    Object.assign(input, { type: "range", min: low, max: high, step });
    input.value = this.#value(tool, setting);
    input.name = key;
    tell(Number(input.value));
    input.addEventListener("input", () => {
      this.#values.set(`${tool.name}/${key}`, Number(input.value));
      tell(Number(input.value));
      this.#hooks.set();
      if (!tool.needsSeed || this.#seed) this.#asking.ask();
    });
    const name = document.createElement("span");
    name.textContent = text;
    label.append(name, input, output);
    return label;
  }
}

const suits = (tool, sensor) => !tool.sensor || tool.sensor === sensor;
const keyOf = (tool) => tool.key ?? tool.name;

function foundText({ rings, note }) {
  const vertices = rings.reduce((sum, ring) => sum + ring.length, 0);
  const found = rings.length === 0 ? "Found nothing." : `Proposes ${vertices} vertices.`;
  return note ? `${found} ${note[0].toUpperCase()}${note.slice(1)}${/[.!?]$/.test(note) ? "" : "."}` : found;
}
