// The pointer on the picture: which tool gets it, zooming and moving.

import { brushTool, lassoTool, livewireTool, polygonTool } from "./drawing-tools.js";
import { isInside, onCanvas } from "./frame-view.js";
import { keyPointTool } from "./key-point-tool.js";
import { vertexTool } from "./vertex-tool.js";

const WHEEL_STEP = 0.0015;
const SIZES_PX = [0.5, 40];

export class Editor {
  session;
  view;
  scene;
  brushRadius = 3;
  combining = "add";
  #canvas;
  #tools;
  #tool;
  #hooks;
  #panFrom = null;
  #isSpaceHeld = false;
  #hasPanned = false;
  #isDown = false;

  /** Edit `session`'s outline with the pointer on `canvas`; `hooks` tell the page. */
  constructor(canvas, view, session, scene, hooks) {
    Object.assign(this, { session, view, scene });
    this.#canvas = canvas;
    this.#hooks = hooks;
    const tools = [
      vertexTool(this),
      polygonTool(this),
      lassoTool(this),
      brushTool(this, true),
      brushTool(this, false),
      livewireTool(this),
      keyPointTool(this),
      this.#growTool(),
    ];
    this.#tools = new Map(tools.map((tool) => [tool.name, tool]));
    this.#tool = tools[0];
    canvas.addEventListener("pointerdown", (event) => this.#down(event));
    canvas.addEventListener("pointermove", (event) => this.#move(event));
    canvas.addEventListener("pointerup", (event) => this.#up(event));
    canvas.addEventListener("pointercancel", () => this.cancel());
    canvas.addEventListener("pointerleave", () => this.#leave());
    canvas.addEventListener("dblclick", () => this.#tool.double?.());
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => this.#wheel(event), { passive: false });
    addEventListener("keydown", (event) => event.code === "Space" && this.#holdSpace(event));
    addEventListener("keyup", (event) => event.code === "Space" && this.#letSpaceGo());
    addEventListener("blur", () => this.#letSpaceGo());
  }

  get keyPoints() {
    return this.#hooks.keyPoints;
  }

  get toolName() {
    return this.#tool.name;
  }

  /** Whether the space bar, now let go, moved the picture. */
  get spaceMovedPicture() {
    return this.#hasPanned;
  }

  toCanvas = (row, column) => onCanvas(this.view.plot(), row, column);

  choose(name) {
    this.cancel();
    this.#tool = this.#tools.get(name);
    this.scene.hovered = null;
    this.scene.brush = null;
    this.setCursor(this.#tool.cursor);
    this.#hooks.onTool(name);
    this.redraw();
  }

  setSize(pixels) {
    this.brushRadius = Math.min(Math.max(pixels, SIZES_PX[0]), SIZES_PX[1]);
    if (this.scene.brush) this.scene.brush.radius = this.brushRadius;
    this.redraw();
  }

  setCursor(cursor) {
    this.#canvas.style.cursor = cursor;
  }

  redraw() {
    this.#hooks.redraw();
  }

  complain(sentence) {
    this.#hooks.complain(sentence);
  }

  /** Close the ring being drawn; false where there is none. */
  accept() {
    return this.#tool.accept?.() ?? false;
  }

  /** Give up what is being drawn; false where nothing is. */
  cancel() {
    const hadOne = this.#tool.cancel?.() ?? false;
    this.#isDown = false;
    this.session.isBusy = false;
    this.redraw();
    return hadOne;
  }

  /** Take out the selected vertex, or the last point of what is being drawn. */
  remove() {
    if (this.scene.draft) this.#tool.back?.();
    else this.#tool.remove?.();
    this.redraw();
  }

  #growTool() {
    return {
      name: "grow",
      cursor: "cell",
      down: (event, place) => {
        const [row, column] = this.view.pixelAt(...place);
        this.#hooks.onSeed(row, column);
        return false;
      },
      move() {},
      up(_event) {},
    };
  }

  #down(event) {
    if (!this.view.hasFrame) return;
    const place = [event.offsetX, event.offsetY];
    this.#canvas.focus({ preventScroll: true });
    if (event.button === 1 || (event.button === 0 && this.#isSpaceHeld)) {
      event.preventDefault();
      this.#panFrom = place;
      this.#canvas.setPointerCapture(event.pointerId);
      this.setCursor("grabbing");
      return;
    }
    const isUsable = event.button === 0 && this.session.isEditable && !this.scene.proposal;
    const isSeeding = event.button === 0 && this.#tool.name === "grow";
    if (!(isUsable || isSeeding) || !isInside(this.view.plot(), ...place)) return;
    this.#hooks.onStart();
    if (this.#tool.down(event, place) === true) {
      this.#isDown = true;
      this.session.isBusy = true;
      this.#canvas.setPointerCapture(event.pointerId);
    }
    this.redraw();
  }

  #move(event) {
    if (!this.view.hasFrame) return;
    const place = [event.offsetX, event.offsetY];
    if (this.#panFrom) {
      this.#hasPanned = true;
      this.view.pan(place[0] - this.#panFrom[0], place[1] - this.#panFrom[1]);
      this.#panFrom = place;
      return;
    }
    this.scene.cursor = this.view.pixelAt(...place);
    if (this.session.isEditable && !this.#isSpaceHeld) this.#tool.move(event, place);
    this.redraw();
  }

  #up(event) {
    if (this.#panFrom) {
      this.#panFrom = null;
      this.setCursor(this.#isSpaceHeld ? "grab" : this.#tool.cursor);
    } else if (this.#isDown) {
      this.#isDown = false;
      this.session.isBusy = false;
      this.#tool.up(event);
    }
    this.redraw();
  }

  #leave() {
    this.scene.cursor = null;
    if (!this.#isDown) this.scene.hovered = null;
    this.#tool.leave?.();
    this.redraw();
  }

  #wheel(event) {
    if (!this.view.hasFrame || !isInside(this.view.plot(), event.offsetX, event.offsetY)) return;
    event.preventDefault();
    const pixels = event.deltaMode === 1 ? 30 * event.deltaY : event.deltaY;
    this.view.zoom(Math.exp(-WHEEL_STEP * pixels), [event.offsetX, event.offsetY]);
  }

  #holdSpace(event) {
    if (event.repeat || event.target.closest?.("input, select, textarea, button, dialog")) return;
    this.#isSpaceHeld = true;
    this.#hasPanned = false;
    this.setCursor("grab");
  }

  #letSpaceGo() {
    if (!this.#isSpaceHeld) return;
    this.#isSpaceHeld = false;
    this.setCursor(this.#tool.cursor);
  }
}
