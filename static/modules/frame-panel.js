// The frame on show: its picture, its outline, and what lies over both.

import { part } from "./elements.js";
import { frameRows, showNote, showRows } from "./facts-view.js";
import { FrameView } from "./frame-view.js";
import { Latest } from "./latest.js";
import { LayerLegend } from "./layer-legend.js";
import { withUnit } from "./numbers.js";
import { COLOURS, Overlay } from "./overlay.js";
import { composed } from "./screenshot.js";
import { framePath, getJson, getLevels } from "./server.js";
import { Session } from "./session.js";

const LAYERS = ["ghost", "hull", "shadow"];

export class FramePanel {
  view;
  session;
  /** What is drawn over the picture. */
  scene = { rings: null, cursor: null, isHidden: false };
  /** Called whenever another part of the frame is on show. */
  onMoved = () => {};
  /** Gives the key points to draw over the picture. */
  keyPoints = () => null;
  #overlay = new Overlay(part("overlay-canvas"));
  #onChange;
  #drawing = 0;
  #legend = new LayerLegend(part("overlay-legend"));
  #layers = new Set(["shadow"]);
  #rule = "shadow";
  #reprojection = null;
  #seenOverlays = "";
  #bringing = new Latest(() => this.#fetchOverlays(), 60);
  #hull = 0;

  /**
   * Call `onChange()` when the outline changes, `onComplaint(sentence)` for what is refused, and
   * `onGo(number)` to see another frame.
   */
  constructor(onChange, onComplaint, onGo) {
    this.#onChange = onChange;
    this.view = new FrameView(part("frame-canvas"), showReading, (plot) => {
      this.#overlay.setPlot(plot);
      this.redraw();
      this.onMoved();
    });
    this.session = new Session(() => this.#show(), onComplaint, onGo);
  }

  /** What lies over the picture besides the outline: of "ghost", "hull", "shadow". */
  layers() {
    return LAYERS.filter((name) => this.#layers.has(name));
  }

  /** Show these layers and no other; names that are none are passed over. */
  setLayers(names) {
    this.#layers = new Set(names.filter((name) => LAYERS.includes(name)));
    this.bringOverlays();
    this.#onChange();
  }

  toggleLayer(name) {
    const others = this.layers().filter((other) => other !== name);
    this.setLayers(this.#layers.has(name) ? others : [...others, name]);
  }

  /** Draw what lies over the picture, once for all changes of a moment. */
  redraw() {
    if (this.#drawing) return;
    this.#drawing = requestAnimationFrame(() => {
      this.#drawing = 0;
      this.#arrange();
      this.#overlay.draw(this.scene);
    });
  }

  /** The picture with what lies over it, but for the handles, as one canvas with a title. */
  picture(title) {
    const { frame } = this.session;
    this.#arrange();
    this.#overlay.draw({ ...this.scene, isEditable: false, isHidden: false, brush: null, draft: null });
    const canvases = [part("frame-canvas"), part("overlay-canvas")];
    const legend = [[this.scene.colour, "outline"], ...this.#legend.entries()];
    const whole = composed(canvases, { title, stamp: `frame ${frameStamp(frame)}`, legend });
    this.redraw();
    return whole;
  }

  /** Bring the scene up to what the session and the layers are. */
  #arrange() {
    const { session, scene } = this;
    const { frame } = session;
    Object.assign(scene, {
      rings: frame && session.rings,
      claim: session.claim,
      component: session.component,
      colour: session.component === "target" ? COLOURS.outline : frame?.colour,
      others: frame?.others ?? [],
      isEditable: session.isEditable,
      mine: session.conflict?.rings ?? null,
      shape: frame?.shape,
      isShaded: session.claim !== "complete" && this.#rule === "shadow",
      showsShadow: this.#layers.has("shadow"),
      keyPoints: this.keyPoints(),
    });
    this.#legend.show({
      frame,
      session,
      proposal: scene.proposal,
      reprojection: this.#layers.has("hull") ? this.#reprojection : null,
      wantsHull: this.#layers.has("hull"),
      wantsGhost: this.#layers.has("ghost"),
      wantsShadow: scene.isShaded && scene.showsShadow && session.rings.length > 0,
    });
  }

  async fetch(number) {
    const path = framePath(number, this.session.component);
    return Promise.all([getJson(path), getLevels(number)]);
  }

  take(frame, levels) {
    part("frame-empty").hidden = true;
    this.scene.selected = null;
    this.scene.hovered = null;
    this.scene.draft = null;
    this.scene.ghost = null;
    this.scene.reprojection = null;
    this.#reprojection = null;
    this.session.adopt(frame);
    this.view.setFrame(frame, levels);
    part("frame-canvas").dataset.frame = frame.number;
    this.bringOverlays();
  }

  clear() {
    this.session.clear();
    this.view.clear();
    part("frame-empty").hidden = false;
    part("frame-canvas").dataset.frame = 0;
  }

  /** Follow the hull of what is outlined, and the rule by which it is carved. */
  follow({ hull, carving, components, serial }) {
    this.#rule = carving.rule;
    const own = components.find(({ label }) => label === this.session.component);
    const shown = own?.hull ?? hull;
    // Previews one after the other bear one number, that which would be kept.
    this.bringOverlays(shown?.is_preview ? `preview ${serial}` : shown?.revision);
  }

  /** Get what lies under the outline anew where the frame or the hull is another. */
  bringOverlays(hull = this.#hull) {
    this.#hull = hull;
    const [wantsGhost, wantsHull] = ["ghost", "hull"].map((name) => this.#layers.has(name));
    if (!wantsGhost) this.scene.ghost = null;
    if (!wantsHull) this.scene.reprojection = null;
    const { number } = this.session.frame ?? {};
    const wanted = [number, this.session.component, hull, wantsGhost, wantsHull].join("/");
    this.redraw();
    if (wanted === this.#seenOverlays && number) return;
    this.#seenOverlays = wanted;
    if (number) this.#bringing.ask(hull);
  }

  async #fetchOverlays() {
    const { frame } = this.session;
    if (frame === null) return;
    const { number } = frame;
    const { component } = this.session;
    const neighbour = number > 1 ? number - 1 : number + 1;
    const get = (name, path) => (this.#layers.has(name) ? getJson(path).catch(() => null) : null);
    const [ghost, hull] = await Promise.all([
      get("ghost", framePath(neighbour, component)),
      get("hull", framePath(number, component, "/reprojection")),
    ]);
    if (this.session.frame?.number !== number || this.session.component !== component) return;
    this.scene.ghost = this.#layers.has("ghost") && ghost ? onto(frame, ghost) : null;
    this.#reprojection = this.#layers.has("hull") ? hull : null;
    this.scene.reprojection = this.#reprojection?.rings ?? null;
    this.redraw();
  }

  #show() {
    const { frame } = this.session;
    part("frame-stamp").textContent = frame ? frameStamp(frame) : "";
    part("frame-stamp").title = part("frame-stamp").textContent;
    showNote(part("frame-note"), frame ? noteOf(frame) : "");
    if (frame) showRows(part("frame-facts"), frameRows(frame));
    else part("frame-facts").replaceChildren();
    showHint(this.session);
    this.bringOverlays();
    this.#onChange();
  }
}

/** Begin a part that this frame has no outline of yet. */
function showHint({ frame, component, rings }) {
  part("part-hint").hidden = frame === null || component === "target" || rings.length > 0;
  part("part-hint").textContent = `Draw the ${component} in this frame; frames without it don’t count.`;
}

function noteOf({ note, silhouette }) {
  const { component, rings } = silhouette;
  if (component !== "target" && rings.length === 0) return "";
  return note || (silhouette.repair ?? "").replace(/\.$/, "");
}

/** Another frame's rings where they lie on this one, origin upon origin and metre upon metre. */
function onto(frame, other) {
  const scale = (key) => (other[key] ?? 1) / (frame[key] ?? 1);
  const [rowScale, columnScale] = [scale("row_spacing_m"), scale("column_spacing_m")];
  return other.silhouette.rings.map((ring) => ring.map(([row, column]) => [
    frame.origin_px[0] + (row - other.origin_px[0]) * rowScale,
    frame.origin_px[1] + (column - other.origin_px[1]) * columnScale,
  ]));
}

function frameStamp({ number, label, time_s: time }) {
  return [number, label, withUnit(time, 1, "s")].filter(Boolean).join(", ");
}

function showReading(reading) {
  const output = part("readout");
  if (reading === null) {
    output.textContent = "Point at the picture to read it.";
    return;
  }
  const pairs = [
    ["range", reading.range],
    ["cross-range", reading.crossRange],
    ["", reading.level],
  ];
  output.replaceChildren(
    ...pairs.flatMap(([name, value], index) => {
      const bold = document.createElement("b");
      bold.textContent = value;
      return [`${index ? " · " : ""}${name}${name && " "}`, bold];
    }),
  );
}
