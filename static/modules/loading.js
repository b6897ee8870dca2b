// Loading another source, and outlines from files: chosen, dropped anywhere, and given up.

import { confirmed } from "./confirm.js";
import { all, part } from "./elements.js";
import { frames } from "./numbers.js";
import { send, upload } from "./server.js";

/** As the server has them; it would hang up in the middle of a larger file. */
const LARGEST_BYTES = { pass: 2 * 2 ** 30, outlines: 64 * 2 ** 20 };

export class Loading {
  #hooks;
  #running = null;
  #ownKey = "";
  #depth = 0;

  /**
   * `hooks.complain(sentence, kind)`; `hooks.state()`; `hooks.isBusy()` while somebody draws;
   * `hooks.hasConflict()` where an outline waits to be kept or given up.
   */
  constructor(hooks) {
    this.#hooks = hooks;
    const open = {
      pass: () => this.choosePass(),
      demo: () => this.#loadDemo(),
      outlines: () => part("outlines-file").click(),
    };
    for (const button of all("[data-open]")) {
      button.addEventListener("click", () => {
        part("open-menu").hidePopover();
        open[button.dataset.open]();
      });
    }
    for (const id of ["pass-file", "outlines-file"]) {
      part(id).addEventListener("change", () => {
        const [file] = part(id).files;
        part(id).value = "";
        if (file) this.#take(file, id === "pass-file" ? "pass" : "outlines");
      });
    }
    part("loading-cancel").addEventListener("click", () => this.#running?.cancel());
    this.#takeDrops(window);
  }

  choosePass() {
    part("pass-file").click();
  }

  update({ frames: received }) {
    part("open-outlines").disabled = received === 0;
  }

  /** Whether a state shows the source that this page itself has loaded. */
  isOwn({ source }) {
    return this.#running !== null || source.key === this.#ownKey;
  }

  /** Take files that are dropped on a frame's page, which keeps them from ours. */
  takeDropsOn(frame) {
    const listen = () => frame.contentWindow && this.#takeDrops(frame.contentWindow);
    listen();
    frame.addEventListener("load", listen);
  }

  #takeDrops(target) {
    const isFile = (event) => event.dataTransfer?.types.includes("Files");
    const zone = part("drop-zone");
    const on = (name, act) => target.addEventListener(name, (event) => {
      // A page that was loaded twice into the same window listens twice.
      if (!isFile(event) || event.defaultPrevented) return;
      event.preventDefault();
      act(event);
    });
    on("dragenter", () => {
      this.#depth += 1;
      zone.hidden = false;
    });
    on("dragover", () => {
      zone.hidden = false;
    });
    on("dragleave", (event) => {
      this.#depth -= 1;
      // Over the zone itself, which covers everything, nothing else is entered or left.
      if (this.#depth <= 0 || event.relatedTarget === null) this.#endDrag();
    });
    on("drop", (event) => {
      this.#endDrag();
      this.#drop([...event.dataTransfer.files]);
    });
  }

  #endDrag() {
    this.#depth = 0;
    part("drop-zone").hidden = true;
  }

  #drop(files) {
    if (files.length !== 1) {
      this.#hooks.complain(`One file is taken at a time; ${files.length} were dropped.`);
      return;
    }
    this.#take(files[0], /\.(json|png|zip)$/i.test(files[0].name) ? "outlines" : "pass");
  }

  async #take(file, kind) {
    const most = LARGEST_BYTES[kind];
    if (file.size > most) {
      this.#hooks.complain(`${file.name} has ${sizeText(file.size)}; at most ${sizeText(most)} are taken.`);
      return;
    }
    if (kind === "pass" && !(await this.#mayDiscard())) return;
    const query = new URLSearchParams({ name: file.name });
    const path = kind === "pass" ? "/api/source" : "/api/silhouettes";
    const answer = await this.#run(file.name, (tell) => upload(`${path}?${query}`, file, tell));
    if (answer && kind === "pass") this.#ownKey = answer.source.key;
    else if (answer) this.#hooks.complain(importedText(file.name, answer), "note");
  }

  async #loadDemo() {
    if (!(await this.#mayDiscard())) return;
    const answer = await this.#run("the demo", () => ({
      done: send("POST", "/api/source", { demo: true }),
    }));
    if (answer) this.#ownKey = answer.source.key;
  }

  /** Do `start(tell)` with its progress on show; gives its answer, nothing if it came to none. */
  async #run(name, start) {
    if (this.#running || this.#hooks.isBusy()) {
      this.#hooks.complain("Something is being saved or loaded still; try again when it is done.");
      return undefined;
    }
    this.#hooks.complain("");
    this.#tell(`Loading ${name}…`);
    part("loading").hidden = false;
    try {
      this.#running = start((sent, total) => {
        if (sent >= total) this.#tell(`Reading ${name}…`);
        else this.#tell(`Uploading ${name}: ${sizeText(sent)} of ${sizeText(total)}`, sent / total);
      });
      part("loading-cancel").hidden = !this.#running.cancel;
      return await this.#running.done;
    } catch (error) {
      if (error.name !== "AbortError") this.#hooks.complain(error.message);
      return undefined;
    } finally {
      this.#running = null;
      part("loading").hidden = true;
    }
  }

  /** Once all is sent the server reads it, which nobody can call off. */
  #tell(text, share) {
    const bar = part("loading-bar");
    part("loading-text").textContent = text;
    part("loading-cancel").hidden = share === undefined;
    if (share === undefined) bar.removeAttribute("value");
    else bar.value = share;
  }

  async #mayDiscard() {
    const infos = this.#hooks.state()?.frames_info ?? [];
    const unsaved = this.#hooks.hasConflict() ? 1 : 0;
    const edited = infos.filter((info) => info.edited).length + unsaved;
    if (edited === 0) return true;
    const outlines = edited === 1 ? "1 edited outline" : `${edited} edited outlines`;
    return confirmed({
      title: "Load another pass?",
      text: `Loading another pass discards ${outlines}. Export them first.`,
      action: edited === 1 ? "Discard it and load" : "Discard them and load",
    });
  }
}

function importedText(name, { changed, unchanged }) {
  const same = unchanged.length === 0 ? "" : ` ${frames(unchanged.length)} had it already.`;
  if (changed.length === 0) return `Every outline in ${name} is on its frame already.`;
  return `${frames(changed.length)} took over an outline from ${name}; each can be undone.${same}`;
}

function sizeText(bytes) {
  if (bytes < 1e6) return `${Math.ceil(bytes / 1e3)} kB`;
  return bytes < 1e9 ? `${(bytes / 1e6).toFixed(1)} MB` : `${(bytes / 1e9).toFixed(2)} GB`;
}
