// What stands in the line across the page: the one thing that matters most, with what can be done.

import { Banner } from "./banner.js";
import { part } from "./elements.js";
import { fewViewsText } from "./source-view.js";

const LOST = "The connection to the server is lost; trying again. What is on screen may be old.";

export class Notices {
  /** Whether the server does not answer. */
  isLinkLost = false;
  #banner = new Banner(part("banner"));
  #session;
  #hooks;
  #state = null;
  #complaint = "";
  #kind = "bad";
  #dismissed = "";

  /** Tell of `session`'s conflicts and the state; `hooks.restart()`, `hooks.choosePass()`. */
  constructor(session, hooks) {
    this.#session = session;
    this.#hooks = hooks;
  }

  complain(sentence, kind = "bad") {
    this.#complaint = sentence;
    this.#kind = kind;
    this.show();
  }

  /** Forget the last complaint, without a word. */
  forget() {
    this.#complaint = "";
  }

  update(state) {
    this.#state = state;
    this.show();
  }

  show() {
    if (this.isLinkLost) this.#showLost();
    else if (this.#session.conflict) this.#showConflict();
    else if (this.#complaint) {
      this.#banner.show(this.#complaint, [["Dismiss", () => this.complain("")]], this.#kind);
    } else this.#showNotice();
  }

  #showLost() {
    const { conflict } = this.#session;
    const kept = `Your outline of frame ${conflict?.number} is kept on this page, not saved yet.`;
    this.#banner.show(conflict?.isUnsaved ? `${LOST} ${kept}` : LOST);
  }

  #showConflict() {
    const { isUnsaved, number } = this.#session.conflict;
    const what = isUnsaved
      ? `Your outline of frame ${number} was not saved: the server did not answer.`
      : `Frame ${number} was changed on another page meanwhile.`;
    this.#banner.show(`${what} The kept outline is on show, yours is the dashed one.`, [
      ["Keep mine", () => this.#session.keepMine()],
      ["Take theirs", () => this.#session.keepTheirs()],
    ]);
  }

  /** Why no more frames come, or why there are no numbers yet, until somebody has read it. */
  #showNotice() {
    const state = this.#state;
    const isRead = state === null || this.#dismissed === keyOf(state);
    const dismissal = ["Dismiss", () => this.#dismiss()];
    if (!isRead && state.message) {
      this.#banner.show(failureText(state), [
        ["Try again", () => this.#hooks.restart()],
        ["Open another pass…", () => this.#hooks.choosePass()],
        dismissal,
      ]);
    } else if (!isRead && fewViewsText(state)) this.#banner.show(fewViewsText(state), [dismissal], "note");
    else this.#banner.show("");
  }

  #dismiss() {
    this.#dismissed = keyOf(this.#state);
    this.show();
  }
}

const keyOf = ({ source, run }) => `${source.key}/${run}`;

/** What a program says, as a person writes it, and what stays usable. */
function failureText({ message, frames }) {
  const sentence = `${message.charAt(0).toUpperCase()}${message.slice(1).replace(/[.!?]*$/, "")}.`;
  if (frames === 0) return sentence;
  const before = frames === 1 ? "frame" : `${frames} frames`;
  return `${sentence} The ${before} before that can still be edited and measured.`;
}
