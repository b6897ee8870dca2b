// The source of the frames, and how far its imaging is.

import { frames } from "./numbers.js";

const part = (id) => document.getElementById(id);

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
  bar.hidden = total === null;
  if (status === "preparing") bar.removeAttribute("value");
  else if (total !== null) bar.value = state.frames / total;
}

function statusText({ status, source, frames: received }) {
  const total = source.expected_frames;
  const place = total === null ? `frame ${received}` : `frame ${received} of ${total}`;
  return {
    preparing: `Preparing ${source.name}…`,
    playing: `Imaging ${place}`,
    paused: received === 0 ? "Paused before the first frame" : `Paused at ${place}`,
    finished: `All ${frames(received)} received`,
    failed: received === 0 ? "Failed before the first frame" : `Failed after ${place}`,
  }[status];
}
