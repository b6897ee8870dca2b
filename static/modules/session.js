// The outline on show: what the server keeps of it, and what has been drawn since.

import { EditTrail } from "./edit-trail.js";
import { Latest } from "./latest.js";
import { copied, rounded, sameRings } from "./rings.js";
import { framePath, getJson, send } from "./server.js";

const PREVIEW_PAUSE_MS = 30;

export class Session {
  frame = null;
  rings = [];
  claim = "lit side";
  /** What it outlines: the whole target or a part of it; another frame's is of the same. */
  component = "target";
  /** Whether somebody is drawing, so that news from the server must wait. */
  isBusy = false;
  /** The outline that lost to another page's, or was not saved, until it is kept or given up. */
  conflict = null;
  /** Grows with every frame that is taken off, so that an answer about it is known as old. */
  #epoch = 0;
  #revisions = new Map();
  #pending = 0;
  #chain = Promise.resolve();
  #hasPreview = false;
  /** By component. */
  #trails = new Map();
  #onChange;
  #onComplaint;
  #onGo;
  #preview = new Latest((wish) => this.#sendPreview(wish), PREVIEW_PAUSE_MS);

  /**
   * Call `onChange()` after each change, `onComplaint(sentence)` for what the server refuses, and
   * `onGo(number)` where undoing begins with going to another frame.
   */
  constructor(onChange, onComplaint, onGo) {
    this.#onChange = onChange;
    this.#onComplaint = onComplaint;
    this.#onGo = onGo;
  }

  get isEditable() {
    return this.frame?.silhouette.revision !== undefined;
  }

  get isSaving() {
    return this.#pending > 0;
  }

  /** Take a frame as the server gives it. */
  adopt(frame) {
    const { component } = frame.silhouette;
    const isSame = this.frame?.number === frame.number && this.component === component;
    if (!isSame) this.conflict = null;
    this.frame = frame;
    this.rings = copied(frame.silhouette.rings);
    this.claim = frame.silhouette.claim;
    this.component = component;
    this.#note(frame);
    this.#onChange();
  }

  /** Go over to the outline of another component; raises what the server says to its name. */
  async choose(component) {
    await this.#chain;
    await this.withdraw();
    const { number } = this.frame;
    const frame = await getJson(framePath(number, component));
    if (this.frame?.number === number) this.adopt(frame);
  }

  clear() {
    this.#epoch += 1;
    this.frame = null;
    this.rings = [];
    this.conflict = null;
    this.#trails.clear();
    this.#onChange();
  }

  /** Whether the server has a newer outline in the frame on show, of any component, than this page. */
  isBehind(info) {
    if (!info || !this.isEditable || this.isBusy || this.isSaving || this.conflict !== null) return false;
    const own = this.#revision(this.frame.number, this.component);
    const known = { ...this.frame.revisions, [this.component]: own };
    return Object.entries(info.revisions).some(([label, revision]) => revision > (known[label] ?? -1));
  }

  /** Change the outline on the page, and let the hull follow without keeping it. */
  sketch(rings, tool) {
    this.rings = rings;
    this.preview(rings, tool);
    this.#onChange();
  }

  /** Let the hull follow an outline that is not even the page's. */
  preview(rings, tool, claim = this.claim) {
    this.previewOf(() => rings, tool, claim);
  }

  /** Likewise, with rings that cost something: they are made only once they can be sent. */
  previewOf(make, tool, claim = this.claim) {
    if (!this.isEditable) return;
    this.#hasPreview = true;
    this.#preview.ask({ number: this.frame.number, make, ...this.#body([], claim, tool) });
  }

  /** Take a preview back. */
  async withdraw() {
    if (!this.#hasPreview) return;
    const { number } = this.frame;
    this.#hasPreview = false;
    await this.#preview.stop();
    await send("DELETE", framePath(number, this.component, "/preview")).catch((error) => {
      this.#onComplaint(error.message);
    });
  }

  /** Keep an outline: on the page at once, on the server as soon as it answers. */
  commit(rings, tool, claim = this.claim) {
    if (!this.isEditable) return this.#chain;
    const { number, silhouette } = this.frame;
    const isSame = claim === silhouette.claim && sameRings(rings, silhouette.rings);
    Object.assign(this, { rings, claim });
    this.#onChange();
    if (isSame && !this.isSaving) return this.withdraw();
    const job = { number, epoch: this.#epoch, ...this.#body(rings, claim, tool) };
    return this.#queue(() => this.#save(job));
  }

  /** Take the last edit of the frame on show back; where it has none, go to the last edit's. */
  undo() {
    return this.#travel("undo");
  }

  redo() {
    return this.#travel("redo");
  }

  /** The frame that undo or redo acts on, which may have to be gone to first; null for none. */
  targetOf(direction) {
    if (!this.isEditable) return null;
    const { number, silhouette } = this.frame;
    if (this.isSaving || silhouette[`can_${direction}`]) return number;
    return this.#trail(this.component).elsewhere(direction, number);
  }

  /** After a conflict: put this page's outline over the other one. */
  keepMine() {
    const mine = this.conflict;
    this.conflict = null;
    if (mine && mine.number === this.frame?.number) {
      this.commit(mine.rings, mine.tool, mine.claim);
    }
  }

  keepTheirs() {
    this.conflict = null;
    this.#onChange();
  }

  /** Get the outline on show anew. */
  async refresh() {
    const { number } = this.frame;
    try {
      this.#arrive(await getJson(framePath(number, this.component)));
    } catch (error) {
      this.#onComplaint(error.message);
    }
  }

  #travel(direction) {
    if (!this.isEditable || this.isBusy) return this.#chain;
    const { number } = this.frame;
    const { component } = this;
    const target = this.targetOf(direction);
    if (target !== number) return target === null ? this.#chain : this.#onGo(target);
    return this.#queue(async () => {
      this.#preview.forget();
      const body = { component, base_revision: this.#revision(number, component) };
      const frame = await send("POST", `/api/frames/${number}/${direction}`, body);
      this.#trail(component).note(direction, number);
      return frame;
    });
  }

  /** Do `work`, which gives a frame, after what is already being saved. */
  #queue(work) {
    this.#pending += 1;
    this.#chain = this.#chain.then(async () => {
      let frame;
      try {
        frame = await work();
      } catch (error) {
        this.#onComplaint(error.message);
        // What the server refuses is not on it; the page goes back to what is.
        const path = framePath(this.frame?.number, this.component);
        frame = error.status ? await getJson(path).catch(() => undefined) : undefined;
      }
      this.#pending -= 1;
      if (frame) this.#arrive(frame);
      this.#onChange();
    });
    return this.#chain;
  }

  async #save({ number, epoch, ...body }) {
    if (this.conflict?.number === number) {
      // What was drawn after the lost outline is the one to keep.
      this.conflict = { ...this.conflict, ...body };
      return undefined;
    }
    // One under way is not waited for: after this the server refuses it as made from an old outline.
    this.#preview.forget();
    this.#hasPreview = false;
    body.base_revision = this.#revision(number, body.component);
    try {
      const frame = await send("PUT", `/api/frames/${number}/silhouette`, body);
      this.#trail(body.component).note("edit", number);
      return frame;
    } catch (error) {
      if (epoch !== this.#epoch) throw error;
      if (error.status === undefined) {
        this.conflict = { number, ...body, isUnsaved: true };
        return undefined;
      }
      if (error.status !== 409) throw error;
      return this.#lose({ number, ...body });
    }
  }

  async #lose(mine) {
    const theirs = await getJson(framePath(mine.number, mine.component));
    if (this.#isOnShow(theirs)) this.conflict = mine;
    return theirs;
  }

  #arrive(frame) {
    this.#note(frame);
    if (!this.#isOnShow(frame)) return;
    // What is being drawn, or waits to be saved, is newer than this answer.
    if (this.isBusy || this.isSaving) this.frame = frame;
    else this.adopt(frame);
  }

  async #sendPreview({ number, make, ...body }) {
    let rings;
    try {
      rings = rounded(make());
    } catch {
      return; // The polygon library gives up on some strokes; the next move makes another.
    }
    await send("PUT", `/api/frames/${number}/preview`, { ...body, rings }).catch((error) => {
      // A crossed outline in the middle of a drag is nothing to complain of.
      if (error.status === undefined) this.#onComplaint(error.message);
    });
  }

  #body(rings, claim, tool) {
    return {
      rings: rounded(rings),
      claim,
      component: this.component,
      tool,
      base_revision: this.#revision(this.frame.number, this.component),
    };
  }

  #isOnShow({ number, silhouette }) {
    return this.frame?.number === number && this.component === silhouette.component;
  }

  #note({ number, silhouette }) {
    this.#revisions.set(`${number}/${silhouette.component}`, silhouette.revision);
  }

  #revision(number, component) {
    return this.#revisions.get(`${number}/${component}`);
  }

  #trail(component) {
    if (!this.#trails.has(component)) this.#trails.set(component, new EditTrail());
    return this.#trails.get(component);
  }
}
