// Canvases that are drawn anew with every move of the pointer.

/**
 * A blank context of a canvas of so many pixels.
 *
 * Drawn by the processor: a few hundred vertices are soon done there, sooner than by a graphics
 * library that is itself software; nor is the memory asked for anew each time.
 */
export function cleared(canvas, width, height) {
  const context = canvas.getContext("2d", { willReadFrequently: true });
  if (canvas.width === width && canvas.height === height) context.reset();
  else Object.assign(canvas, { width, height });
  return context;
}
