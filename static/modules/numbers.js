// How numbers look: a true minus sign, fixed decimals, units after a narrow space.

const SPACE = "\u202f";

/** A number with fixed decimals and a true minus sign; "–" stands for none. */
export function fixed(value, decimals) {
  if (value === null || value === undefined) return "–";
  const text = Math.abs(value).toFixed(decimals);
  return value < 0 && Number(text) !== 0 ? `−${text}` : text;
}

/** A number with its unit. */
export function withUnit(value, decimals, unit) {
  return `${fixed(value, decimals)}${SPACE}${unit}`;
}

/** A sentence in which no line ends between a number and its unit. */
export function keptTogether(sentence) {
  return sentence.replace(/(\d) (?=(m|px|rad|s)\b)/g, "$1\u00a0");
}

/** A count with thousands set apart. */
export function count(value) {
  return String(value).replace(/\B(?=(\d{3})+$)/g, SPACE);
}

/** A vector's components to two decimals. */
export function vector(components) {
  return components.map((component) => fixed(component, 2)).join(", ");
}

/** "1 frame", "12 frames". */
export function frames(number) {
  return number === 1 ? "1 frame" : `${count(number)} frames`;
}

/** "1 view", "12 views". */
export function views(number) {
  return number === 1 ? "1 view" : `${count(number)} views`;
}

/** "213.4 s into pass 2", for the time begins again with each pass. */
export function timeText(seconds, label) {
  const time = withUnit(seconds, 1, "s");
  return label.startsWith("pass ") ? `${time} into ${label}` : time;
}

/** Evenly spaced round values within [low, high], about `wanted` of them. */
export function roundSteps(low, high, wanted) {
  const rough = (high - low) / wanted;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((size) => size >= rough);
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  const decimals = Math.max(0, -Math.floor(Math.log10(step)));
  return Array.from({ length: last - first + 1 }, (_, index) => (first + index) * step).map(
    (value) => ({ value, text: fixed(value, decimals) }),
  );
}
