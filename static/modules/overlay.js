// What lies over the picture: outline and handles, drafts, proposals, ghosts, disagreement.
//
// A plain canvas and not a tree of shapes: an extracted outline has hundreds of vertices, whose
// handles keep their size on screen at every zoom.

import { cleared } from "./canvas.js";
import { clipTo, onCanvas } from "./frame-view.js";
import { Hatcher } from "./hatching.js";
import { drawKeyPoints } from "./key-point-overlay.js";
import { between, middleOf, shadowStrips } from "./rings.js";

export const COLOURS = {
  outline: "#40e0d0",
  proposal: "#ffd24a",
  mine: "#ff7ac6",
  ghost: "#b9c4d6",
  reprojection: "#8fb0ff",
  cut: "#ff7b72",
  dark: "#0b0e14",
};

const SPARSE_PX = 18;
const NEAR_PX = 70;
const MIDDLE_FROM_PX = 22;
const FONT = '600 12px system-ui, "Segoe UI", "Helvetica Neue", "Noto Sans", "DejaVu Sans", sans-serif';

export class Overlay {
  #canvas;
  #hatcher = new Hatcher();
  #plot = null;

  constructor(canvas) {
    this.#canvas = canvas;
  }

  setPlot(plot) {
    this.#plot = plot;
  }

  /** Draw a scene: rings and what to do with them; `isHidden` leaves the picture bare. */
  draw(scene) {
    const canvas = this.#canvas;
    const scale = window.devicePixelRatio;
    const context = cleared(canvas, Math.round(canvas.clientWidth * scale), Math.round(canvas.clientHeight * scale));
    const plot = this.#plot;
    if (plot === null || scene.rings === null || scene.isHidden) return;
    context.setTransform(scale, 0, 0, scale, 0, 0);
    context.save();
    clipTo(context, plot);
    context.lineJoin = "round";
    if (scene.isShaded && scene.showsShadow) this.#drawShadow(context, scene);
    if (scene.reprojection) this.#drawDisagreement(context, scene);
    if (scene.ghost) this.#line(context, scene.ghost, COLOURS.ghost, 1.25, [2, 3]);
    if (scene.mine) this.#line(context, scene.mine, COLOURS.mine, 1.5, [7, 4]);
    for (const { rings, colour } of scene.others) this.#line(context, rings, colour, 1, []);
    this.#line(context, scene.rings, scene.colour, 1.75, []);
    if (scene.proposal) this.#line(context, scene.proposal, COLOURS.proposal, 1.75, [6, 4]);
    const hasHandles = scene.isEditable && !scene.proposal && !scene.keyPoints?.isMarking;
    if (hasHandles) this.#drawHandles(context, scene);
    if (scene.draft) this.#drawDraft(context, scene);
    if (scene.brush) this.#drawBrush(context, scene.brush, scene.colour);
    if (scene.keyPoints) drawKeyPoints(context, plot, scene.keyPoints);
    context.restore();
    drawClaim(context, plot, scene);
  }

  #trace(context, rings, isClosed = true) {
    context.beginPath();
    for (const ring of rings) {
      ring.forEach(([row, column], index) => {
        const place = onCanvas(this.#plot, row, column);
        if (index === 0) context.moveTo(...place);
        else context.lineTo(...place);
      });
      if (isClosed) context.closePath();
    }
  }

  #line(context, rings, colour, width, dashes, isClosed = true) {
    this.#trace(context, rings, isClosed);
    context.setLineDash([]);
    context.strokeStyle = "rgb(5 8 14 / 60%)";
    context.lineWidth = width + 1.75;
    context.stroke();
    context.setLineDash(dashes);
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.stroke();
    context.setLineDash([]);
  }

  /** What a lit side leaves open behind it: hatched, for it is no part of the outline. */
  #drawShadow(context, scene) {
    this.#hatcher.draw(context, "shadow", [this.#shadow(scene), this.#area(scene.rings)]);
  }

  /** One hatch where only the outline is, another where only the hull is and may not be. */
  #drawDisagreement(context, scene) {
    const [drawn, hull] = [this.#area(scene.rings), this.#area(scene.reprojection)];
    const shadow = scene.isShaded ? [this.#shadow(scene)] : [];
    this.#hatcher.draw(context, "onlyOutline", [drawn, hull]);
    this.#hatcher.draw(context, "onlyHull", [hull, drawn, ...shadow]);
    this.#line(context, scene.reprojection, COLOURS.reprojection, 1.25, [3, 3]);
  }

  #area(rings) {
    return [(context) => this.#trace(context, rings), "evenodd"];
  }

  #shadow({ rings, shape }) {
    const strips = shadowStrips(rings, shape[0] - 0.5);
    return [(context) => this.#trace(context, strips), "nonzero"];
  }

  /** Handles of vertices, and of middles of long edges; near the cursor only where they crowd. */
  #drawHandles(context, { rings, colour, cursor, selected, hovered }) {
    const cursorPlace = cursor && onCanvas(this.#plot, ...cursor);
    const isNear = (place) => cursorPlace !== null && between(place, cursorPlace) < NEAR_PX;
    rings.forEach((ring) => {
      const places = ring.map((vertex) => onCanvas(this.#plot, ...vertex));
      const isSparse = meanStep(places) > SPARSE_PX;
      places.forEach((place, index) => {
        const next = places[(index + 1) % places.length];
        const middle = middleOf(place, next);
        if (between(place, next) > MIDDLE_FROM_PX && (isSparse || isNear(middle))) {
          dot(context, middle, 3, COLOURS.dark, colour);
        }
        if (isSparse || isNear(place)) dot(context, place, isSparse ? 4 : 3, colour, COLOURS.dark);
      });
    });
    for (const [mark, radius] of [[hovered, 5.5], [selected, 6]]) {
      const vertex = mark && rings[mark.ring]?.[mark.index];
      if (vertex) dot(context, onCanvas(this.#plot, ...vertex), radius, "#ffffff", COLOURS.dark);
    }
  }

  #drawDraft(context, { draft, cursor }) {
    const points = cursor && draft.followsCursor ? [...draft.points, cursor] : draft.points;
    this.#line(context, [points], draft.isCut ? COLOURS.cut : COLOURS.proposal, 1.75, [], false);
    if (!draft.followsCursor) return;
    for (const point of draft.marks ?? draft.points) {
      dot(context, onCanvas(this.#plot, ...point), 4, COLOURS.proposal, COLOURS.dark);
    }
  }

  #drawBrush(context, { points, centre, radius, isAdding }, own) {
    const pixel = this.#plot.height / this.#plot.rows;
    const across = this.#plot.width / this.#plot.columns;
    const colour = isAdding ? own : COLOURS.cut;
    if (points.length > 0) {
      this.#trace(context, [points], false);
      if (points.length === 1) context.lineTo(...onCanvas(this.#plot, points[0][0], points[0][1] + 1e-3));
      context.lineCap = "round";
      context.globalAlpha = 0.4;
      context.strokeStyle = colour;
      context.lineWidth = 2 * radius * pixel;
      context.stroke();
      context.globalAlpha = 1;
    }
    if (!centre) return;
    context.beginPath();
    context.ellipse(...onCanvas(this.#plot, ...centre), radius * across, radius * pixel, 0, 0, 2 * Math.PI);
    context.strokeStyle = colour;
    context.lineWidth = 1.5;
    context.stroke();
  }
}

/** What the outline claims to show, and of which part, in the plot's lower left corner. */
function drawClaim(context, plot, { claim, component, colour, rings }) {
  if (rings.length === 0 && component !== "target") return;
  const shown = claim === "complete" ? "complete outline" : "lit side";
  const named = component === "target" ? shown : `${component}, ${shown}`;
  const text = rings.length === 0 ? "no target" : named;
  context.font = FONT;
  context.textAlign = "left";
  context.textBaseline = "middle";
  const width = context.measureText(text).width + 16;
  context.fillStyle = "rgb(11 14 20 / 82%)";
  context.beginPath();
  context.roundRect(plot.x + 8, plot.y + plot.height - 32, width, 24, 5);
  context.fill();
  context.fillStyle = claim === "complete" && rings.length > 0 && component === "target" ? COLOURS.proposal : colour;
  context.fillText(text, plot.x + 16, plot.y + plot.height - 20);
}

function meanStep(places) {
  const whole = places.reduce(
    (sum, place, index) => sum + between(place, places[(index + 1) % places.length]), 0,
  );
  return whole / Math.max(places.length, 1);
}

function dot(context, place, radius, fill, edge) {
  context.beginPath();
  context.arc(...place, radius, 0, 2 * Math.PI);
  context.fillStyle = fill;
  context.fill();
  context.strokeStyle = edge;
  context.lineWidth = 1.25;
  context.stroke();
}
