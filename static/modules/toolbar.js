// What stands around the picture: tools, undo, overlays, levels and colours.

import { withUnit } from "./numbers.js";
import { getJson } from "./server.js";

const part = (id) => document.getElementById(id);
const NARROWEST_DB = 5;

export class Toolbar {
  #panel;
  #editor;
  #windowM;
  #colours = new Map();
  #fitsTarget = true;

  /** Control `panel` and `editor`; `windowM()` is the side that fits the target, in metres. */
  constructor(panel, editor, windowM) {
    this.#panel = panel;
    this.#editor = editor;
    this.#windowM = windowM;
    const { session } = panel;
    panel.onMoved = () => this.#tellFit();
    part("undo").addEventListener("click", () => session.undo());
    part("redo").addEventListener("click", () => session.redo());
    part("claim").addEventListener("click", () => this.toggleClaim());
    part("ghost").addEventListener("click", () => panel.toggleGhost());
    part("overlay").addEventListener("click", () => panel.toggleHull());
    part("zoom-target").addEventListener("click", () => this.fit(true));
    part("zoom-whole").addEventListener("click", () => this.fit(false));
    part("brush-size").addEventListener("input", (event) => this.#setBrush(Number(event.target.value)));
    part("combining").addEventListener("change", (event) => {
      editor.combining = event.target.value;
    });
    part("floor").addEventListener("input", () => this.#setLevels("floor"));
    part("top").addEventListener("input", () => this.#setLevels("top"));
    part("colours").addEventListener("change", () => this.chooseColours());
    this.#setBrush(Number(part("brush-size").value));
  }

  onTool(choose) {
    for (const button of this.#toolButtons()) {
      button.addEventListener("click", () => choose(button.dataset.tool));
    }
  }

  /** Offer the tools that need the server only where it has them. */
  offer(known) {
    for (const button of this.#toolButtons()) {
      button.hidden = button.dataset.tool === "livewire" && !known.includes("livewire");
    }
  }

  update() {
    const { session, wantsGhost, wantsHull } = this.#panel;
    const silhouette = session.frame?.silhouette;
    const tool = this.#editor.toolName;
    for (const button of this.#toolButtons()) {
      button.ariaPressed = String(button.dataset.tool === tool);
      button.disabled = !session.isEditable;
    }
    part("undo").disabled = !silhouette?.can_undo;
    part("redo").disabled = !silhouette?.can_redo;
    part("claim").disabled = !session.isEditable;
    part("claim-text").textContent = session.claim === "complete" ? "Complete" : "Lit side";
    part("ghost").ariaPressed = String(wantsGhost);
    part("overlay").ariaPressed = String(wantsHull);
    part("overlay-legend").hidden = !wantsHull;
    part("brush-size-label").hidden = !["brush", "eraser", "vertex"].includes(tool);
    part("brush-size-name").textContent = tool === "vertex" ? "Reach" : "Size";
    part("combining-label").hidden = !["polygon", "lasso", "livewire"].includes(tool);
    part("frame-canvas").dataset.revision = silhouette?.revision ?? "";
    part("frame-canvas").dataset.saving = String(session.isSaving);
  }

  /** Claim the other: that the outline shows the lit side only, or all of it. */
  toggleClaim() {
    const { session } = this.#panel;
    if (!session.isEditable) return;
    session.commit(session.rings, "claim", session.claim === "complete" ? "lit side" : "complete");
  }

  scaleBrush(factor) {
    this.#setBrush(this.#editor.brushRadius * factor);
  }

  /** Fit the target or the whole frame. */
  fit(isTarget) {
    this.#fitsTarget = isTarget;
    this.#panel.view.fit(isTarget ? this.#windowM() : null);
    this.#tellFit();
  }

  /** Keep to the choice between target and whole for the next frame, and to a chosen part. */
  keepWindow() {
    this.#panel.view.setWindow(this.#fitsTarget ? this.#windowM() : null);
  }

  async chooseColours() {
    const name = part("colours").value;
    if (!this.#colours.has(name)) this.#colours.set(name, await getJson(`/api/colours?name=${name}`));
    if (part("colours").value === name) this.#panel.view.setColours(this.#colours.get(name));
  }

  #tellFit() {
    const { isFree } = this.#panel.view;
    part("zoom-target").ariaPressed = String(this.#fitsTarget && !isFree);
    part("zoom-whole").ariaPressed = String(!this.#fitsTarget && !isFree);
  }

  #setBrush(radius) {
    this.#editor.setSize(radius);
    part("brush-size").value = this.#editor.brushRadius;
    part("brush-size-value").textContent = withUnit(this.#editor.brushRadius, 1, "px");
  }

  #setLevels(changed) {
    let [floorDb, topDb] = [Number(part("floor").value), Number(part("top").value)];
    if (topDb - floorDb < NARROWEST_DB) {
      if (changed === "floor") topDb = Math.min(floorDb + NARROWEST_DB, 0);
      floorDb = Math.min(floorDb, topDb - NARROWEST_DB);
      part("floor").value = floorDb;
      part("top").value = topDb;
    }
    part("floor-value").textContent = withUnit(floorDb, 0, "dB");
    part("top-value").textContent = withUnit(topDb, 0, "dB");
    this.#panel.view.setLevels(floorDb, topDb);
  }

  #toolButtons() {
    return document.querySelectorAll("#tools button[data-tool]");
  }
}
