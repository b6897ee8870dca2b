// The frame on show: its picture, its outline, and what lies over both.

import { frameRows, showNote, showRows } from "./facts-view.js";
import { FrameView } from "./frame-view.js";
import { Latest } from "./latest.js";
import { withUnit } from "./numbers.js";
import { Overlay } from "./overlay.js";
import { getJson, getLevels } from "./server.js";
import { Session } from "./session.js";

const part = (id) => document.getElementById(id);

export class FramePanel {
  view;
  session;
  /** What is drawn over the picture. */
  scene = { rings: null, cursor: null, isHidden: false };
  /** Called whenever another part of the frame is on show. */
  onMoved = () => {};
  #overlay = new Overlay(part("overlay-canvas"));
  #onChange;
  #drawing = 0;
  #wantsGhost = false;
  #wantsHull = false;
  #seenOverlays = "";
  #bringing = new Latest((hull) => this.#fetchOverlays(hull), 60);
  #hull = 0;

  /** Call `onChange()` when the outline changes and `onComplaint(sentence)` for what is refused. */
  constructor(onChange, onComplaint) {
    this.#onChange = onChange;
    this.view = new FrameView(part("frame-canvas"), showReading, (plot) => {
      this.#overlay.setPlot(plot);
      this.redraw();
      this.onMoved();
    });
    this.session = new Session(() => this.#show(), onComplaint);
  }

  get wantsGhost() {
    return this.#wantsGhost;
  }

  get wantsHull() {
    return this.#wantsHull;
  }

  /** Draw what lies over the picture, once for all changes of a moment. */
  redraw() {
    this.#drawing ||= requestAnimationFrame(() => {
      this.#drawing = 0;
      const { session, scene } = this;
      scene.rings = session.frame && session.rings;
      scene.claim = session.claim;
      scene.isEditable = session.isEditable;
      scene.mine = session.conflict?.rings ?? null;
      this.#overlay.draw(scene);
    });
  }

  async fetch(number) {
    return Promise.all([getJson(`/api/frames/${number}`), getLevels(number)]);
  }

  take(frame, levels) {
    part("frame-empty").hidden = true;
    this.scene.selected = null;
    this.scene.hovered = null;
    this.scene.draft = null;
    this.scene.ghost = null;
    this.scene.reprojection = null;
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

  toggleGhost() {
    this.#wantsGhost = !this.#wantsGhost;
    this.bringOverlays();
    this.#onChange();
  }

  toggleHull() {
    this.#wantsHull = !this.#wantsHull;
    this.bringOverlays();
    this.#onChange();
  }

  /** Get what lies under the outline anew where the frame or the hull is another. */
  bringOverlays(hull = this.#hull) {
    this.#hull = hull;
    if (!this.#wantsGhost) this.scene.ghost = null;
    if (!this.#wantsHull) this.scene.reprojection = null;
    const { number } = this.session.frame ?? {};
    const wanted = [number, hull, this.#wantsGhost, this.#wantsHull].join("/");
    if (wanted === this.#seenOverlays && number) return;
    this.#seenOverlays = wanted;
    if (number) this.#bringing.ask(hull);
    this.redraw();
  }

  async #fetchOverlays() {
    const { frame } = this.session;
    if (frame === null) return;
    const { number } = frame;
    const neighbour = number > 1 ? number - 1 : number + 1;
    const [ghost, hull] = await Promise.all([
      this.#wantsGhost ? getJson(`/api/frames/${neighbour}`).catch(() => null) : null,
      this.#wantsHull ? getJson(`/api/frames/${number}/reprojection`).catch(() => null) : null,
    ]);
    if (this.session.frame?.number !== number) return;
    this.scene.ghost = this.#wantsGhost && ghost ? onto(frame, ghost) : null;
    this.scene.reprojection = this.#wantsHull && hull ? hull.rings : null;
    this.redraw();
  }

  #show() {
    const { frame } = this.session;
    part("frame-stamp").textContent = frame ? frameStamp(frame) : "";
    part("frame-stamp").title = part("frame-stamp").textContent;
    showNote(part("frame-note"), frame ? noteOf(frame) : "");
    if (frame) showRows(part("frame-facts"), frameRows(frame));
    else part("frame-facts").replaceChildren();
    this.redraw();
    this.#onChange();
  }
}

function noteOf({ note, silhouette }) {
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
    ["level", reading.level],
  ];
  output.replaceChildren(
    ...pairs.flatMap(([name, value], index) => {
      const bold = document.createElement("b");
      bold.textContent = value;
      return [`${index ? " · " : ""}${name} `, bold];
    }),
  );
}
