// Panels of which one is on show, chosen by its tab.

export class Tabs {
  #tabs;

  constructor(tabs) {
    this.#tabs = [...tabs];
    for (const tab of this.#tabs) {
      tab.addEventListener("click", () => this.open(tab.dataset.tab));
      tab.addEventListener("keydown", (event) => this.#onKey(event, tab));
    }
  }

  open(name) {
    for (const tab of this.#tabs) {
      const isOpen = tab.dataset.tab === name;
      tab.ariaSelected = String(isOpen);
      tab.tabIndex = isOpen ? 0 : -1;
      document.getElementById(tab.getAttribute("aria-controls")).hidden = !isOpen;
    }
  }

  #onKey(event, tab) {
    const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (by === undefined) return;
    // Elsewhere arrows leaf through the frames.
    event.stopPropagation();
    const next = this.#tabs.at((this.#tabs.indexOf(tab) + by) % this.#tabs.length);
    this.open(next.dataset.tab);
    next.focus();
  }
}
