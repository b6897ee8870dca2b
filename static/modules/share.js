// Links to a state: the frame on show, this page's camera, and its layers.

import { part } from "./elements.js";

/** Of layers that lie over the frame's picture, in a link. */
const OVER_PICTURE = "frame.";
const CAMERA_NUMBERS = 10;
const COPIED_MS = 1600;

export class Share {
  #space;
  #panel;
  #actions;
  #state = null;
  /** Number of a linked frame that has not arrived yet. */
  #awaited = null;

  /** Share what `space` and the frame's `panel` show; `actions` are showFrame(n) and complain(text). */
  constructor(space, panel, actions) {
    this.#space = space;
    this.#panel = panel;
    this.#actions = actions;
    part("space-link").addEventListener("click", () => this.#copy());
    part("link-text").addEventListener("focus", () => part("link-text").select());
    addEventListener("hashchange", () => this.#open());
  }

  update(state) {
    const isFirst = this.#state === null;
    this.#state = state;
    if (isFirst) this.#open();
    this.#showAwaited();
  }

  async #copy() {
    try {
      const link = await this.#link();
      if (await isCopied(link)) sayCopied();
      else showLink(link);
    } catch (error) {
      this.#actions.complain(error.message);
    }
  }

  async #link() {
    const camera = await this.#space.camera();
    const over = (this.#panel.layers?.() ?? []).map((name) => OVER_PICTURE + name);
    const address = new URL(location.href);
    address.hash = hashOf({
      frame: this.#state?.shown ?? null,
      camera,
      layers: [...this.#space.layers, ...over],
    });
    return address.href;
  }

  /** Show what the address names, then take it out: a reload must not move the frame again. */
  async #open() {
    if (location.hash.length < 2) return;
    const { wishes, complaints } = readHash(location.hash);
    history.replaceState(null, "", location.pathname + location.search);
    try {
      complaints.push(...await this.#show(wishes));
    } catch (error) {
      complaints.push(error.message);
    }
    if (complaints.length > 0) this.#actions.complain(`The link: ${complaints.join("; ")}.`);
  }

  /** @param {{ frame?: any, camera?: any, layers?: any }} wishes */
  async #show({ frame, camera, layers }) {
    const complaints = [];
    this.#awaited = frame ?? null;
    this.#showAwaited();
    if (layers) {
      const isOver = (name) => name.startsWith(OVER_PICTURE);
      const unknown = await this.#space.setLayers(layers.filter((name) => !isOver(name)));
      if (unknown.length > 0) complaints.push(`there is no layer ${unknown.join(", ")}`);
      const over = layers.filter(isOver).map((name) => name.slice(OVER_PICTURE.length));
      this.#panel.setLayers?.(over);
    }
    if (camera) await this.#space.setCamera(camera);
    return complaints;
  }

  #showAwaited() {
    const state = this.#state;
    if (this.#awaited === null || state === null) return;
    const isOver = ["finished", "failed"].includes(state.status);
    const most = isOver ? state.frames : (state.source.expected_frames ?? Infinity);
    const number = this.#awaited;
    if (number <= state.frames) {
      this.#awaited = null;
      if (number !== state.shown) this.#actions.showFrame(number);
    } else if (number > most) {
      this.#awaited = null;
      this.#actions.complain(`The link: there is no frame ${number}; this source has ${most}.`);
    }
  }
}

/** Write a state as a link's last part; what is not known is left out. */
export function hashOf({ frame, camera, layers }) {
  const parts = [];
  if (frame !== null) parts.push(`frame=${frame}`);
  if (camera !== null) {
    const { position, look_at: lookAt, up, field_of_view_deg: fieldOfView } = camera;
    const numbers = [...position, ...lookAt, ...up, fieldOfView];
    // What rounding left of nothing would be read aloud as 1.27e-33; small tilts are kept.
    const rounded = (number) => (Math.abs(number) < 1e-15 ? 0 : Number(number.toPrecision(7)));
    parts.push(`camera=${numbers.map(rounded).join(",")}`);
  }
  parts.push(`layers=${layers.map(encodeURIComponent).join(",")}`);
  return parts.join("&");
}

/** Read a link's last part: what it wishes for, and a complaint for each thing not understood. */
export function readHash(hash) {
  /** @type {{ frame?: any, camera?: any, layers?: any }} */
  const wishes = {};
  const complaints = [];
  for (const wish of hash.replace(/^#/, "").split("&")) {
    const [key, ...rest] = wish.split("=");
    const read = Object.hasOwn(READERS, key) ? READERS[key](rest.join("=")) : undefined;
    if (read === undefined) complaints.push(`“${wish.slice(0, 40)}” is not understood`);
    else wishes[key] = read;
  }
  return { wishes, complaints };
}

const READERS = {
  frame: (text) => (/^[1-9]\d{0,6}$/.test(text) ? Number(text) : undefined),
  camera: (text) => {
    const numbers = text.split(",").map((word) => (word === "" ? NaN : Number(word)));
    if (numbers.length !== CAMERA_NUMBERS || !numbers.every(Number.isFinite)) return undefined;
    return {
      position: numbers.slice(0, 3),
      look_at: numbers.slice(3, 6),
      up: numbers.slice(6, 9),
      field_of_view_deg: numbers[9],
    };
  },
  layers: (text) => {
    try {
      return text === "" ? [] : text.split(",").map(decodeURIComponent);
    } catch {
      return undefined;
    }
  },
};

/** Whether the browser put a text on the clipboard; it may have none, or be forbidden. */
async function isCopied(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return false;
  }
}

function sayCopied() {
  const button = part("space-link");
  button.textContent = "Copied";
  setTimeout(() => { button.textContent = "Link"; }, COPIED_MS);
}

function showLink(link) {
  part("link-text").value = link;
  part("link-sheet").showModal();
  part("link-text").focus();
}
