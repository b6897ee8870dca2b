// One request at a time, of which only the latest wish counts.

export class Latest {
  #send;
  #pauseMs;
  #wish = null;
  #running = null;

  /** Call the asynchronous `send(wish)` for the newest wish, `pauseMs` after the one before. */
  constructor(send, pauseMs = 0) {
    this.#send = send;
    this.#pauseMs = pauseMs;
  }

  ask(wish) {
    this.#wish = { wish };
    this.#running ??= this.#work();
  }

  /** Forget what has not been sent. */
  forget() {
    this.#wish = null;
  }

  /** Forget what has not been sent, and wait for what has. */
  async stop() {
    this.forget();
    await this.#running;
  }

  async #work() {
    // The first wish waits too: several of one moment become one.
    await null;
    while (this.#wish !== null) {
      const { wish } = this.#wish;
      this.#wish = null;
      await this.#send(wish);
      if (this.#wish !== null) await new Promise((resolve) => setTimeout(resolve, this.#pauseMs));
    }
    this.#running = null;
  }
}
