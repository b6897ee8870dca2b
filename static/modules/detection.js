// Detecting the target in all frames anew: what would change is said first, and can be taken back.

import { frames } from "./numbers.js";
import { send } from "./server.js";

const PARTS = {
  open: "detect-all",
  why: "detect-why",
  back: "detect-back",
  done: "detect-done",
  dialog: "detection",
  question: "detection-question",
  complaint: "detection-complaint",
  overwrite: "detection-overwrite",
  cancel: "detection-cancel",
  go: "detection-go",
};

export class Detection {
  #parts;
  #hooks;
  #order = null;
  #asked = 0;
  #state = null;

  /** `hooks.settings()` to detect by, `hooks.show(state)`, `hooks.complain(sentence)`. */
  constructor(hooks) {
    const named = Object.entries(PARTS).map(([name, id]) => [name, document.getElementById(id)]);
    const parts = Object.fromEntries(named);
    this.#parts = parts;
    this.#hooks = hooks;
    parts.open.addEventListener("click", () => this.open());
    parts.back.addEventListener("click", () => this.#takeBack());
    parts.overwrite.addEventListener("change", () => this.#count());
    parts.go.addEventListener("click", () => this.#go());
  }

  /** Offer it where it can change something: by other settings, or over what was edited by hand. */
  update(state = this.#state) {
    this.#state = state;
    if (state === null) return;
    const wanted = Object.entries(this.#hooks.settings());
    const isOther = wanted.some(([key, value]) => state.extraction[key] !== value);
    const isEdited = (state.frames_info ?? []).some(({ edited }) => edited);
    this.#parts.open.disabled = !isOther && !isEdited;
    this.#parts.why.hidden = isOther || isEdited;
  }

  /** Ask whether to, naming how many frames would change. */
  async open() {
    const { dialog, overwrite, cancel } = this.#parts;
    overwrite.checked = false;
    this.#order = this.#hooks.settings();
    dialog.showModal();
    cancel.focus();
    await this.#count();
  }

  async #count() {
    const { question, go, overwrite, complaint } = this.#parts;
    this.#asked += 1;
    const own = this.#asked;
    go.disabled = true;
    question.textContent = "Counting the outlines that would change…";
    complaint.hidden = true;
    try {
      const order = { ...this.#order, overwrites_edited: overwrite.checked, only_counts: true };
      const { changed, kept } = await send("POST", "/api/extraction", order);
      if (own !== this.#asked) return;
      question.textContent = questionText(this.#order, changed.length, kept.length);
      go.disabled = changed.length === 0;
      go.textContent = changed.length === 0 ? "Detect" : `Detect in ${frames(changed.length)}`;
    } catch (error) {
      if (own === this.#asked) this.#refuse(error.message);
    }
  }

  async #go() {
    const { dialog, overwrite, go } = this.#parts;
    go.disabled = true;
    try {
      const order = { ...this.#order, overwrites_edited: overwrite.checked };
      const { changed, kept, state } = await send("POST", "/api/extraction", order);
      dialog.close();
      this.#tell(`Detected anew in ${frames(changed.length)}${keptText(kept.length)}.`, true);
      this.#hooks.show(state);
    } catch (error) {
      this.#refuse(error.message);
    }
  }

  async #takeBack() {
    try {
      const { changed, state } = await send("POST", "/api/extraction/undo");
      this.#tell(`Taken back in ${frames(changed.length)}.`, false);
      this.#hooks.show(state);
    } catch (error) {
      this.#hooks.complain(error.message);
    }
  }

  #tell(sentence, canGoBack) {
    this.#parts.done.textContent = sentence;
    this.#parts.back.hidden = !canGoBack;
  }

  #refuse(sentence) {
    const { question, complaint } = this.#parts;
    question.textContent = "";
    complaint.textContent = sentence;
    complaint.hidden = false;
  }
}

function questionText({ a1, a2, closing_px: closing }, changed, kept) {
  const by = `With a₁ = ${a1}, a₂ = ${a2} and a closing of ${closing}\u202fpx`;
  const edited = kept === 0 ? "" : ` The edited ${kept === 1 ? "outline" : "outlines"} of ${frames(kept)} ${kept === 1 ? "is" : "are"} kept.`;
  if (changed === 0) return `${by} no outline changes.${edited}`;
  return `${by} the ${changed === 1 ? "outline" : "outlines"} of ${frames(changed)} will change.${edited}`;
}

function keptText(kept) {
  return kept === 0 ? "" : `; ${frames(kept)} kept the edited outline`;
}
