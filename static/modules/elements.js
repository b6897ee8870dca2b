// The page's elements. They are of any type to the checker: which kind an id has, index.html says.

/** The element of an id.
 * @param {string} id
 * @returns {any}
 */
export const part = (id) => document.getElementById(id);

/** All elements that a selector finds.
 * @param {string} selector
 * @returns {any[]}
 */
export const all = (selector) => [...document.querySelectorAll(selector)];

/** Which elements make up the larger parts of the page. */
export const PARTS = {
  proposals: {
    list: part("tool-list"),
    form: part("tool-form"),
    settings: part("tool-settings"),
    hint: part("tool-hint"),
    complaint: part("tool-complaint"),
    apply: part("tool-apply"),
    discard: part("tool-discard"),
    all: part("tool-all"),
  },
  review: {
    buttons: all("#review button[data-state]"),
    accept: part("accept"),
    count: part("review-count"),
  },
  carving: {
    form: part("carving"),
    title: part("carving-title"),
    rule: part("carving-rule"),
    misses: part("carving-misses"),
    spacing: part("carving-spacing"),
    side: part("carving-side"),
    first: part("carving-first"),
    last: part("carving-last"),
    complaint: part("carving-complaint"),
    hullRevision: part("hull-revision"),
    preview: part("preview-chip"),
    threshold: part("threshold"),
    revision: part("revision"),
    emptied: part("emptied"),
  },
  transport: {
    play: part("play"),
    step: part("step"),
    restart: part("restart"),
    speed: part("speed"),
    cells: part("cells"),
    follow: part("follow"),
    text: part("reel-text"),
  },
  timeline: {
    course: part("course"),
    plots: part("course-plots"),
    readout: part("course-readout"),
    note: part("course-note"),
    toggle: part("toggle-plots"),
  },
};
