// Panes whose widths somebody chose, by pointer or by keys, and which the browser remembers.

const KEY = "radarhull.panes";
const STEP = 0.01;
const LEAST = { first: 0.28, second: 0.2, third: 0.18 };

/** Let the separators share `main`'s width; the second pane gets what the others leave. */
export function resizablePanes(main, separators) {
  const shares = { first: 0.385, third: 0.225, ...remembered() };
  const apply = () => {
    main.style.setProperty("--first", `${100 * shares.first}%`);
    main.style.setProperty("--third", `${100 * shares.third}%`);
    for (const [name, separator] of Object.entries(separators)) {
      separator.ariaValueNow = String(Math.round(100 * shares[name]));
    }
  };
  const set = (name, share) => {
    const other = name === "first" ? "third" : "first";
    const most = 1 - shares[other] - LEAST.second;
    shares[name] = Math.min(Math.max(share, LEAST[name]), most);
    apply();
    remember(shares);
  };
  for (const [name, separator] of Object.entries(separators)) {
    const outward = name === "first" ? 1 : -1;
    separator.addEventListener("pointerdown", (event) => {
      separator.setPointerCapture(event.pointerId);
      // The view in space would swallow the pointer.
      document.body.classList.add("resizing");
    });
    separator.addEventListener("pointermove", (event) => {
      if (!separator.hasPointerCapture(event.pointerId)) return;
      const { left, width } = main.getBoundingClientRect();
      const share = (event.clientX - left) / width;
      set(name, name === "first" ? share : 1 - share);
    });
    separator.addEventListener("lostpointercapture", () => document.body.classList.remove("resizing"));
    separator.addEventListener("keydown", (event) => {
      const by = { ArrowLeft: -STEP, ArrowRight: STEP }[event.key];
      if (by === undefined) return;
      event.preventDefault();
      event.stopPropagation();
      set(name, shares[name] + outward * by);
    });
  }
  apply();
}

function remembered() {
  try {
    const { first, third } = JSON.parse(localStorage.getItem(KEY)) ?? {};
    const isSensible = first >= LEAST.first && third >= LEAST.third && first + third <= 1 - LEAST.second;
    return isSensible ? { first, third } : {};
  } catch {
    return {};
  }
}

function remember(shares) {
  try {
    localStorage.setItem(KEY, JSON.stringify(shares));
  } catch {
    // A browser that keeps nothing still resizes.
  }
}
