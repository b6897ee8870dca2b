// A frame's levels as a picture of one canvas pixel each.

/** Paint levels on `picture` with a table of colours from `floorDb` to `topDb`. */
export function paintLevels(picture, levels, colours, floorDb, topDb) {
  const { rows, columns, numbers } = levels;
  picture.width = columns;
  picture.height = rows;
  const context = picture.getContext("2d", { willReadFrequently: true });
  const image = context.createImageData(columns, rows);
  const pixels = new Uint32Array(image.data.buffer);
  const colourOf = coloursOfNumbers(levels, colours, floorDb, topDb);
  for (let place = 0; place < numbers.length; place += 1) {
    pixels[place] = colourOf[numbers[place]];
  }
  context.putImageData(image, 0, 0);
}

/** The pixel, in the machine's byte order, for each of the 65536 numbers a level can have. */
function coloursOfNumbers({ floorDb: lowest, stepDb }, colours, floorDb, topDb) {
  const bytes = new Uint8Array(4 * colours.length);
  colours.forEach((colour, index) => bytes.set([...colour, 255], 4 * index));
  const pixelOfIndex = new Uint32Array(bytes.buffer);
  const colourOf = new Uint32Array(65536);
  for (let number = 0; number < colourOf.length; number += 1) {
    const share = (lowest + number * stepDb - floorDb) / (topDb - floorDb);
    colourOf[number] = pixelOfIndex[Math.floor(Math.min(Math.max(share, 0), 1) * 255 + 0.5)];
  }
  return colourOf;
}
