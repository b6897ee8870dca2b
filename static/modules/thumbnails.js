// Pictures for the row of frames: one at a time, and only while the page has nothing better to do.

const QUIET_MS = 200;
const LONGEST_WAIT_MS = 1500;

export class Thumbnails {
  #wanted = new Map();
  #isLoading = false;
  #newsMs = 0;
  #nearness;

  /** Load pictures in the order of `nearness(number)`, the smallest first. */
  constructor(nearness) {
    this.#nearness = nearness;
  }

  /** Something has happened that matters more. */
  noteNews() {
    this.#newsMs = performance.now();
  }

  /** Let an image show frame `number` as it stands at `version`; its present picture stays until then. */
  want(image, number, version) {
    if (image.dataset.version === version) return;
    image.dataset.version = version;
    this.#wanted.set(image, number);
    if (!this.#isLoading) this.#work();
  }

  async #work() {
    this.#isLoading = true;
    while (this.#wanted.size > 0) {
      await this.#quiet();
      const [image, number] = this.#next();
      this.#wanted.delete(image);
      if (image.isConnected) await load(image, number);
    }
    this.#isLoading = false;
  }

  #next() {
    return [...this.#wanted].reduce((best, each) =>
      this.#nearness(each[1]) < this.#nearness(best[1]) ? each : best,
    );
  }

  async #quiet() {
    const latestMs = performance.now() + LONGEST_WAIT_MS;
    let leftMs;
    do {
      leftMs = Math.min(this.#newsMs + QUIET_MS, latestMs) - performance.now();
      if (leftMs > 0) await new Promise((resolve) => setTimeout(resolve, leftMs));
    } while (leftMs > 0);
    await new Promise((resolve) => requestIdleCallback(resolve, { timeout: LONGEST_WAIT_MS }));
  }
}

function load(image, number) {
  return new Promise((resolve) => {
    // A picture that does not come leaves the cell as it is.
    image.onload = image.onerror = resolve;
    image.fetchPriority = "low";
    image.src = `/api/frames/${number}/thumbnail?outline=${image.dataset.version}`;
  });
}
