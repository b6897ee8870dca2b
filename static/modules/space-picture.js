// What a canvas of WebGL shows, as a file; and whether the browser can draw such a thing.

/** Whether this browser has the WebGL that the view in space needs. */
export function hasWebGl() {
  const context = document.createElement("canvas").getContext("webgl2");
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return context !== null;
}

/** Return a canvas as a PNG, on the page's ground where it is clear. */
export async function pictureOf(canvas) {
  const copy = document.createElement("canvas");
  copy.width = canvas.width;
  copy.height = canvas.height;
  const context = copy.getContext("2d");
  context.fillStyle = getComputedStyle(document.documentElement).getPropertyValue("--ground");
  context.fillRect(0, 0, copy.width, copy.height);
  // viser keeps what it has drawn, so that there is something to copy between two drawings.
  context.drawImage(canvas, 0, 0);
  const picture = await new Promise((resolve) => copy.toBlob(resolve, "image/png"));
  if (picture === null) throw new Error("The browser could not make a picture of the 3D view.");
  return picture;
}

/** Let the browser download a file under a name. */
export function askFor(file, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(file);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
