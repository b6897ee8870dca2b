// What stands around the picture: tools, undo, claim and label, layers, zoom.

import { all, part } from "./elements.js";
import { withUnit } from "./numbers.js";

export class Toolbar {
  #panel;
  #editor;
  #windowM;
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
    for (const button of this.#layerButtons()) {
      button.addEventListener("click", () => panel.toggleLayer(button.dataset.layer));
    }
    part("zoom-target").addEventListener("click", () => this.fit(true));
    part("zoom-whole").addEventListener("click", () => this.fit(false));
    part("brush-size").addEventListener("input", (event) => this.#setBrush(Number(event.target.value)));
    part("combining").addEventListener("change", (event) => {
      editor.combining = event.target.value;
    });
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
    const { session } = this.#panel;
    const silhouette = session.frame?.silhouette;
    const tool = this.#editor.toolName;
    for (const button of this.#toolButtons()) {
      button.ariaPressed = String(button.dataset.tool === tool);
      button.disabled = !session.isEditable;
    }
    this.#tellHistory("undo", "Undo", "Ctrl Z");
    this.#tellHistory("redo", "Redo", "Ctrl Shift Z");
    part("claim").disabled = !session.isEditable;
    part("claim-text").textContent = session.claim === "complete" ? "Complete" : "Lit side";
    const layers = this.#panel.layers();
    for (const button of this.#layerButtons()) {
      button.ariaPressed = String(layers.includes(button.dataset.layer));
    }
    part("brush-size-label").hidden = !["brush", "eraser", "vertex"].includes(tool);
    part("brush-size-name").textContent = tool === "vertex" ? "Reach" : "Size";
    part("combining-label").hidden = !["polygon", "lasso", "livewire"].includes(tool);
    part("save-picture").disabled = !session.frame;
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

  #tellHistory(direction, name, keys) {
    const { session } = this.#panel;
    const target = session.targetOf(direction);
    const isHere = target === null || target === session.frame?.number;
    const button = part(direction);
    button.disabled = target === null;
    button.title = isHere
      ? `${name} on this frame (${keys})`
      : `Go to frame ${target}, where there is something to ${direction} (${keys})`;
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

  #layerButtons() {
    return all(".frame button[data-layer]");
  }

  #toolButtons() {
    return all("#tools button[data-tool]");
  }
}
