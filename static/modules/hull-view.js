// The hull's panel: extents, lines, surface, or why there is none.

import {
  afterFrames,
  hullRows,
  showExtents,
  showLines,
  showRows,
  showUnobserved,
} from "./facts-view.js";
import { part } from "./elements.js";
import { views } from "./numbers.js";

/** Show the state's hull in its panel, and name it over the view in space. */
export function showHull(state) {
  const { hull } = state;
  const waiting = state.status === "failed" ? "No frame arrived." : "Preparing the first frame…";
  part("hull-body").hidden = hull === null || hull.is_empty;
  part("hull-empty").hidden = hull !== null && !hull.is_empty;
  part("hull-empty").textContent = noHullText(hull, state.frames_info ?? []);
  part("hull-stamp").textContent = hull === null ? "" : afterFrames(hull.frames);
  part("space-empty").hidden = hull !== null;
  part("space-empty").textContent = waiting;
  part("space-stamp").textContent =
    hull === null ? "" : `hull of ${views(hull.views)}, frame ${state.shown}`;
  part("hull-body").dataset.frames = hull?.frames ?? 0;
  part("hull-body").dataset.run = state.run;
  part("hull-body").dataset.revision = hull?.revision ?? 0;
  if (hull === null || hull.is_empty) return;
  const own = state.measurements?.hull;
  const intervals = own?.revision === hull.revision ? own : {};
  showExtents(part("extents"), hull.extents, intervals.extents);
  showLines(part("lines"), hull.lines, intervals.lines);
  part("lines-empty").hidden = hull.lines.length > 0;
  showUnobserved(part("unobserved"), hull, state);
  showRows(part("hull-facts"), hullRows(hull, state.light, state.latency_ms?.last ?? null, intervals.volume));
}

function noHullText(hull, infos) {
  if (hull === null) return "The hull appears with the first frame.";
  if (hull.views === 0 && infos.some((info) => info.held_back)) {
    return "There is no hull: no frame votes. Take frames back in, or let a wider range of them vote.";
  }
  if (hull.views === 0) return "There is no hull: no frame so far shows the target.";
  return "The hull is empty: no point of the target lies inside every silhouette.";
}
