// Making SVG shapes, and finding the mark that somebody clicked.

const SPACE = "http://www.w3.org/2000/svg";
const REACH = 14;

/** A shape with attributes, and with text where it has some. */
export function shape(name, attributes, text = "") {
  const made = document.createElementNS(SPACE, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.textContent = text;
  return made;
}

/** Dots of frames, the one on show last and marked; `places` may hold null. */
export function frameDots(places, shown, classOf = (_number) => "") {
  const dot = (number) => {
    const [x, y] = places[number - 1];
    const isShown = number === shown;
    const title = shape("title", {}, `Frame ${number}`);
    const names = ["dot", isShown ? "shown" : "", classOf(number)].filter(Boolean).join(" ");
    const circle = shape("circle", { cx: x, cy: y, r: isShown ? 6 : 3, class: names });
    circle.dataset.frame = number;
    circle.append(title);
    return circle;
  };
  const numbers = places.map((_, index) => index + 1).filter((number) => places[number - 1]);
  return numbers.sort((a, b) => Number(a === shown) - Number(b === shown)).map(dot);
}

/** Call `go(number)` for the dot nearest to a click on `svg`. */
export function clickDots(svg, go) {
  svg.addEventListener("click", (event) => {
    const matrix = svg.getScreenCTM().inverse();
    const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix);
    let nearest = null;
    let least = REACH;
    for (const dot of svg.querySelectorAll(".dot")) {
      const away = Math.hypot(dot.cx.baseVal.value - x, dot.cy.baseVal.value - y);
      if (away < least) [nearest, least] = [dot, away];
    }
    if (nearest) go(Number(nearest.dataset.frame));
  });
}
