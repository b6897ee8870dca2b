// The right pane's Frame and Residuals tabs, and the greying of numbers that are being recomputed.

import { Coverage } from "./coverage.js";
import { part } from "./elements.js";
import { ResidualsView } from "./residuals-view.js";
import { getJson } from "./server.js";
import { SkyPlot } from "./sky-plot.js";

export class RightPane {
  #sky;
  #coverage;
  #residuals;
  #state = null;
  #passes = [];
  #passesOf = "";
  #waiting = 0;
  #isSaving = false;

  /** `go(number)` shows a frame. */
  constructor({ go }) {
    const sky = { svg: part("sky"), title: part("sky-title"), caption: part("sky-caption") };
    const coverage = {
      svg: part("coverage"),
      shade: part("coverage-shade"),
      caption: part("coverage-caption"),
    };
    const residuals = {
      table: part("residuals"),
      status: part("residuals-status"),
      without: part("without"),
    };
    this.#sky = new SkyPlot(sky, go);
    this.#coverage = new Coverage(coverage, go);
    this.#residuals = new ResidualsView(residuals, go);
    // What nobody sees is not drawn.
    new MutationObserver(() => this.#show()).observe(part("pane-frame"), {
      attributeFilter: ["hidden"],
    });
  }

  update(state) {
    this.#state = state;
    this.#residuals.update(state);
    this.#show();
  }

  /** Grey the numbers until `promise` is settled, and return it. */
  async greyUntil(promise) {
    this.#waiting += 1;
    this.#grey();
    try {
      return await promise;
    } finally {
      this.#waiting -= 1;
      this.#grey();
    }
  }

  greyWhile(isSaving) {
    this.#isSaving = isSaving;
    this.#grey();
  }

  #grey() {
    const isOld = this.#waiting > 0 || this.#isSaving;
    for (const id of ["hull-body", "parts", "book-rows"]) {
      part(id).classList.toggle("stale", isOld);
      part(id).ariaBusy = String(isOld);
    }
  }

  #show() {
    const state = this.#state;
    if (state === null) return;
    part("frame-facts-empty").hidden = state.shown !== null;
    if (part("pane-frame").hidden) return;
    this.#sky.update(state, this.#passes);
    this.#coverage.update(state);
    this.#fetchCourse();
  }

  /** Get the passes' courses once for each source; without them the target's angles stand in. */
  async #fetchCourse() {
    const key = `${this.#state.run}/${this.#state.source.name}`;
    if (key === this.#passesOf) return;
    this.#passesOf = key;
    const { passes = [] } = await getJson("/api/course").catch(() => ({}));
    this.#passes = passes;
    this.#show();
  }
}
