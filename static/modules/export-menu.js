// The menu of files to be had: links that the browser downloads, as far as there is something.

export class ExportMenu {
  #note;
  #links;
  #state = { hull: null, frames: 0 };
  #isLost = false;

  constructor(menu, note) {
    this.#note = note;
    this.#links = [...menu.querySelectorAll("a[data-needs]")];
    for (const link of this.#links) link.dataset.href = link.getAttribute("href");
    menu.addEventListener("click", (event) => {
      if (event.target.closest("a[href]")) menu.hidePopover();
    });
  }

  setLost(isLost) {
    this.#isLost = isLost;
    this.update(this.#state);
  }

  update(state) {
    this.#state = state;
    const missing = whatIsMissing(state, this.#isLost);
    for (const link of this.#links) {
      const isMissing = Boolean(missing[link.dataset.needs]);
      if (isMissing) link.removeAttribute("href");
      else link.setAttribute("href", link.dataset.href);
      link.setAttribute("role", "link");
      link.ariaDisabled = String(isMissing);
    }
    this.#note.textContent = missing.frames || missing.facts || missing.hull;
    this.#note.hidden = this.#note.textContent === "";
  }
}

/** Why each kind of file cannot be had now; empty where it can. */
function whatIsMissing({ hull, frames }, isLost) {
  if (isLost || frames === 0 || hull === null) {
    const none = isLost ? "The server does not answer." : "There is nothing to export before the first frame.";
    return { frames: none, facts: none, hull: none };
  }
  const preview = hull.is_preview ? "The hull follows an outline that is not kept yet." : "";
  const empty = hull.is_empty ? "The hull is empty; its surface cannot be exported." : "";
  return { frames: "", facts: preview, hull: preview || empty };
}
