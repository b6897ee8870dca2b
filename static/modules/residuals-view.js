// Which frame takes from the hull alone, and whose outline the hull leaves open.

import { fixed, withUnit } from "./numbers.js";

export class ResidualsView {
  #parts;
  #go;
  #sort = "causes_m3";
  #state = null;

  /** `parts.table`, `parts.status`, `parts.without`; `go(number)` shows a frame. */
  constructor(parts, go) {
    this.#parts = parts;
    this.#go = go;
    for (const button of parts.table.querySelectorAll("[data-sort]")) {
      button.addEventListener("click", () => {
        this.#sort = button.dataset.sort;
        this.update(this.#state);
      });
    }
  }

  update(state) {
    this.#state = state;
    const { table, status, without } = this.#parts;
    const { residuals = null, hull } = state;
    const isFresh = residuals !== null && residuals.revision === hull?.revision;
    status.textContent = statusText(state, residuals, isFresh);
    status.hidden = isFresh;
    table.hidden = residuals === null;
    without.hidden = residuals === null;
    for (const part of [table, without]) part.classList.toggle("stale", !isFresh);
    if (residuals === null) return;
    this.#showRows(residuals.frames, state);
    without.textContent = withoutText(residuals.frames[state.shown - 1], state, isFresh);
  }

  #showRows(frames, { shown, frames_info: infos = [] }) {
    const { table } = this.#parts;
    for (const button of table.querySelectorAll("[data-sort]")) {
      const isChosen = button.dataset.sort === this.#sort;
      const order = this.#sort === "number" ? "ascending" : "descending";
      button.closest("th").ariaSort = isChosen ? order : "none";
    }
    const direction = this.#sort === "number" ? 1 : -1;
    const sorted = [...frames].sort(
      (a, b) => direction * ((a[this.#sort] ?? -1) - (b[this.#sort] ?? -1)) || a.number - b.number,
    );
    const most = (key) => Math.max(...frames.map((frame) => frame[key] ?? 0), 1e-9);
    const [mostCauses, mostSuffers] = [most("causes_m3"), most("suffers_m2")];
    const focused = document.activeElement?.closest("#residuals tr")?.getAttribute("data-frame");
    table.tBodies[0].replaceChildren(
      ...sorted.map((frame) => {
        const row = document.createElement("tr");
        row.dataset.frame = frame.number;
        row.classList.toggle("shown", frame.number === shown);
        row.addEventListener("click", () => this.#go(frame.number));
        const votes = infos[frame.number - 1]?.votes !== false;
        row.append(
          nameCell(frame.number, frame.number === shown),
          votes
            ? barCell("causes", frame.causes_m3, mostCauses)
            : barCell("causes", null, mostCauses, "no vote"),
          barCell("suffers", frame.suffers_m2, mostSuffers),
        );
        return row;
      }),
    );
    if (focused) table.querySelector(`tr[data-frame="${focused}"] button`)?.focus();
  }
}

function statusText({ hull, status }, residuals, isFresh) {
  if (isFresh) return "";
  if (!hull) return "Residuals come with the hull.";
  if (hull.is_preview) return "An outline is being tried; residuals follow once it is kept or given up.";
  if (status === "playing") return "Residuals follow once no frame comes any more, or playback pauses.";
  return residuals === null ? "Computing…" : "Computing… Until then these are of an earlier hull.";
}

function withoutText(frame, { hull, frames_info: infos = [] }, isFresh) {
  if (!frame) return "";
  if (infos[frame.number - 1]?.votes === false) return `Frame ${frame.number} does not vote.`;
  const more = withUnit(frame.causes_m3, 2, "m³");
  const volume = hull?.volume_m3;
  const keys = "X excludes it and takes it back in.";
  if (!isFresh || volume === null || volume === undefined) {
    return `Without frame ${frame.number} the hull would have ${more} more. ${keys}`;
  }
  const total = withUnit(volume + frame.causes_m3, 1, "m³");
  return `Without frame ${frame.number} the hull would have ${total}, ${more} more. ${keys}`;
}

function nameCell(number, isShown) {
  const cell = document.createElement("th");
  cell.scope = "row";
  const button = document.createElement("button");
  button.type = "button";
  button.className = "link-like";
  button.textContent = number;
  button.ariaLabel = `Show frame ${number}`;
  if (isShown) button.ariaCurrent = "true";
  cell.append(button);
  return cell;
}

function barCell(kind, value, most, missing = "–") {
  const cell = document.createElement("td");
  const bar = document.createElement("i");
  bar.className = `bar ${kind}`;
  bar.style.width = `${(100 * (value ?? 0)) / most}%`;
  const track = document.createElement("span");
  track.className = "bar-track";
  track.append(bar);
  const number = document.createElement("span");
  number.textContent = value === null ? missing : fixed(value, 2);
  cell.append(track, number);
  return cell;
}
