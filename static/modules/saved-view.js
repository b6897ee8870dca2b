// Whether what was drawn is on the server, in the top bar.

import { part } from "./elements.js";

/** Say whether the outline on show is saved, is on its way, or has not arrived. */
export function showSaved(session, isLinkLost) {
  const [name, text] = savedText(session, isLinkLost);
  part("saved").hidden = session.frame === null;
  part("saved").dataset.saved = name;
  if (part("saved-text").textContent !== text) part("saved-text").textContent = text;
}

function savedText({ conflict, isSaving }, isLinkLost) {
  if (conflict?.isUnsaved) return ["unsaved", isLinkLost ? "Not saved: no connection" : "Not saved: no answer"];
  if (conflict) return ["unsaved", "Not saved: changed elsewhere"];
  if (isSaving) return ["saving", "Saving…"];
  return ["saved", "Saved"];
}
