// Which part of the target is being outlined: choosing one, naming a new one, deleting one.

import { confirmed } from "./confirm.js";
import { part } from "./elements.js";
import { frames } from "./numbers.js";
import { send } from "./server.js";

const WHOLE = "target";
const NEW = "";
const DEFAULTS = ["solar panel", "antenna", "boom", "body"];

export class Parts {
  #session;
  #hooks;
  #state = null;
  #seen = "";

  /**
   * Choose what `session` edits. `hooks.leave()` ends what is being drawn, `hooks.show(state)` and
   * `hooks.complain(sentence)` tell the page.
   */
  constructor(session, hooks) {
    this.#session = session;
    this.#hooks = hooks;
    part("component").addEventListener("change", () => this.#choose(part("component").value));
    part("delete-part").addEventListener("click", () => this.#delete());
    part("new-part-form").addEventListener("submit", (event) => this.#add(event));
    part("new-part-cancel").addEventListener("click", () => part("new-part").close());
    part("new-part").addEventListener("close", () => this.#giveKeysBack());
  }

  /** Offer the parts that have an outline, and the one that is being edited. */
  update(state = this.#state) {
    this.#state = state;
    const { component, isEditable, frame } = this.#session;
    const counts = countsOf(state?.frames_info ?? []);
    const labels = [WHOLE, ...[...counts.keys(), component].filter((label) => label !== WHOLE).sort()];
    const entries = [...new Set(labels)].map((label) => [label, textOf(label, counts)]);
    const seen = JSON.stringify(entries);
    if (seen !== this.#seen) {
      this.#seen = seen;
      const options = entries.map(([label, text]) => new Option(text, label));
      part("component").replaceChildren(...options, new Option("New part…", NEW));
    }
    part("component").disabled = !isEditable;
    part("component").value = component;
    part("component").style.setProperty("--swatch", component === WHOLE ? "" : frame?.colour ?? "");
    part("delete-part").hidden = !counts.has(component) || component === WHOLE;
  }

  async #choose(label) {
    if (label === NEW) {
      this.#ask();
      return;
    }
    try {
      this.#hooks.leave();
      await this.#session.choose(label);
    } catch (error) {
      this.#hooks.complain(error.message);
    }
    this.#giveKeysBack();
  }

  #ask() {
    part("component").value = this.#session.component;
    part("new-part-name").value = "";
    part("new-part-complaint").hidden = true;
    const drawn = new Set([...part("component").options].map(({ value }) => value));
    const free = DEFAULTS.filter((label) => !drawn.has(label));
    part("new-part-names").replaceChildren(...free.map((label) => new Option("", label)));
    part("new-part").showModal();
  }

  /** The server knows what a part may be called. */
  async #add(event) {
    event.preventDefault();
    const complaint = part("new-part-complaint");
    try {
      this.#hooks.leave();
      await this.#session.choose(part("new-part-name").value);
      part("new-part").close();
    } catch (error) {
      complaint.textContent = error.message;
      complaint.hidden = false;
    }
  }

  async #delete() {
    const label = this.#session.component;
    const number = countsOf(this.#state.frames_info).get(label);
    const isMeant = await confirmed({
      title: `Delete ${label}`,
      text: `The outline of “${label}” goes from ${frames(number)}, and with it its hull. In each frame, undo brings it back.`,
      action: "Delete",
    });
    if (!isMeant) return;
    try {
      this.#hooks.leave();
      const path = `/api/components?component=${encodeURIComponent(label)}`;
      this.#hooks.show(await send("DELETE", path));
    } catch (error) {
      this.#hooks.complain(error.message);
    }
  }

  #giveKeysBack() {
    this.update();
    part("frame-canvas").focus({ preventScroll: true });
  }
}

/** In how many frames each part has an outline. */
function countsOf(infos) {
  const counts = new Map();
  for (const label of infos.flatMap(({ components }) => components)) {
    counts.set(label, (counts.get(label) ?? 0) + 1);
  }
  return counts;
}

function textOf(label, counts) {
  if (label === WHOLE) return label;
  return `${label} (${counts.has(label) ? frames(counts.get(label)) : "not drawn yet"})`;
}
