// The source of the frames, and how far its imaging is.

import { part } from "./elements.js";
import { frames, views } from "./numbers.js";

/** Name the state's source and status in the top bar. */
export function showSource(state) {
  const { source, status } = state;
  part("source-name").textContent = source.name;
  part("source-description").textContent = source.description;
  part("source").title = source.description;
  document.title = `${source.name} – radarhull`;
  part("status").textContent = statusText(state);
  part("status").dataset.status = status;
  const bar = part("progress");
  const total = source.expected_frames;
  bar.hidden = total === null || status === "empty";
  if (status === "preparing") bar.removeAttribute("value");
  else if (total !== null) bar.value = state.frames / total;
  part("stop-imaging").hidden = status !== "preparing" && status !== "playing";
  part("frame-empty").textContent = status === "failed" ? "No frame arrived." : "Preparing the first frame…";
  showWelcome(status === "empty");
}

/** Without a source there is nothing to look at but the ways to one. */
function showWelcome(isEmpty) {
  document.body.classList.toggle("without-source", isEmpty);
  part("welcome").hidden = !isEmpty;
}

/** What a person should know of how many views there are, empty if nothing. */
export function fewViewsText({ status, hull, frames: received }) {
  if (status !== "finished" || hull === null || hull.views === 0 || hull.views > 2) return "";
  const pass = received === 1 ? "This pass holds 1 frame" : `This pass gives ${views(hull.views)}`;
  const open = hull.extents.filter((extent) => !extent.is_bounded).map((extent) => extent.name);
  const unbounded = open.length === 0 ? "" : ` Not bounded so far: ${open.join(", ")}.`;
  return `${pass}; a hull takes its form from views in many directions.${unbounded}`;
}

function statusText({ status, source, frames: received }) {
  const total = source.expected_frames;
  const place = total === null ? `frame ${received}` : `frame ${received} of ${total}`;
  return {
    empty: "",
    preparing: `Preparing ${source.name}…`,
    playing: `Imaging ${place}`,
    paused: received === 0 ? "Paused before the first frame" : `Paused at ${place}`,
    finished: `All ${frames(received)} received`,
    failed: received === 0 ? "Failed before the first frame" : `Failed after ${place}`,
  }[status];
}
