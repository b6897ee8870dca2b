// The view in space is a page of its own, whose keys do not come up to ours.

/** Call `onKey(event)` for keys pressed in a frame's page, whichever page that is. */
export function listenInSpace(frame, onKey) {
  const listen = () => frame.contentWindow?.addEventListener("keydown", onKey);
  // It may have loaded before this module did.
  const isThere = frame.contentDocument?.readyState === "complete";
  if (isThere && frame.contentWindow.location.href !== "about:blank") listen();
  frame.addEventListener("load", listen);
}
