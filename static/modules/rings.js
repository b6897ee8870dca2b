// Outlines as plain numbers: rings of [row, column], each not repeated at its end.

import "../vendor/polygon-clipping.js";

const { union, difference } = globalThis.polygonClipping;
const DISC_VERTICES = 24;

/** Rings whose vertices can be moved without touching the original. */
export function copied(rings) {
  return rings.map((ring) => ring.map(([row, column]) => [row, column]));
}

/** Rings to a ten-thousandth of a pixel, which keeps a request small. */
export function rounded(rings) {
  const round = (value) => Math.round(value * 1e4) / 1e4;
  return rings.map((ring) => ring.map(([row, column]) => [round(row), round(column)]));
}

export function sameRings(first, second) {
  return JSON.stringify(rounded(first)) === JSON.stringify(rounded(second));
}

/** The vertex nearest to a place on the canvas, within `reach` CSS pixels, or null. */
export function nearestVertex(rings, toCanvas, place, reach) {
  let best = null;
  rings.forEach((ring, ringIndex) => ring.forEach((vertex, index) => {
    const distance = between(toCanvas(...vertex), place);
    if (distance <= (best?.distance ?? reach)) best = { ring: ringIndex, index, distance };
  }));
  return best;
}

/** The edge whose middle is nearest to a place on the canvas, within `reach`, or null. */
export function nearestMiddle(rings, toCanvas, place, reach) {
  let best = null;
  rings.forEach((ring, ringIndex) => ring.forEach((vertex, index) => {
    const middle = middleOf(vertex, ring[(index + 1) % ring.length]);
    const distance = between(toCanvas(...middle), place);
    if (distance <= (best?.distance ?? reach)) best = { ring: ringIndex, index, middle, distance };
  }));
  return best;
}

/** Rings with a vertex put in after vertex `index`. */
export function inserted(rings, { ring, index }, vertex) {
  const result = copied(rings);
  result[ring].splice(index + 1, 0, [...vertex]);
  return result;
}

/** Rings without a vertex; a ring of fewer than three goes altogether. */
export function removed(rings, { ring, index }) {
  const result = copied(rings);
  result[ring].splice(index, 1);
  return result.filter(({ length }) => length >= 3);
}

/**
 * Rings with a vertex moved by (rows, columns); neighbours within `reach` frame pixels along the
 * ring follow it, less and less by half a cosine, so that a dense outline bends and gets no spike.
 * @param {number[]} by
 */
export function moved(rings, { ring, index }, by, reach) {
  const [rows, columns] = by;
  const result = copied(rings);
  const original = rings[ring];
  const weights = new Map([[index, 1]]);
  for (const direction of [1, -1]) {
    let length = 0;
    for (let step = 1; step < original.length; step += 1) {
      const here = modulo(index + direction * step, original.length);
      length += between(original[here], original[modulo(here - direction, original.length)]);
      if (length >= reach) break;
      const weight = 0.5 + 0.5 * Math.cos((Math.PI * length) / reach);
      weights.set(here, Math.max(weight, weights.get(here) ?? 0));
    }
  }
  for (const [here, weight] of weights) {
    result[ring][here][0] += weight * rows;
    result[ring][here][1] += weight * columns;
  }
  return result;
}

/** Rings with the inside of another ring added, cut out, or put in their place. */
export function combined(rings, ring, how) {
  if (how === "replace" || (how === "add" && rings.length === 0)) return cleaned(union([ring]));
  const whole = evenOdd(rings);
  return cleaned(how === "add" ? union(whole, [ring]) : difference(whole, [ring]));
}

/** Rings with all places within `radius` of a stroke's points added or cut out. */
export function brushed(rings, points, radius, isAdding) {
  const discs = thinned(points, radius / 4).map((point) => disc(point, radius));
  const pieces = discs.map((ring, index) => [convexHull([...ring, ...(discs[index + 1] ?? [])])]);
  const stroke = union(...pieces);
  if (isAdding && rings.length === 0) return cleaned(stroke);
  return cleaned((isAdding ? union : difference)(evenOdd(rings), stroke));
}

function disc([row, column], radius) {
  return Array.from({ length: DISC_VERTICES }, (_, index) => {
    const angle = (2 * Math.PI * index) / DISC_VERTICES;
    return [row + radius * Math.sin(angle), column + radius * Math.cos(angle)];
  });
}

/** The convex hull of points, by Andrew's monotone chain (1979). */
function convexHull(points) {
  const sorted = points.toSorted((a, b) => a[0] - b[0] || a[1] - b[1]);
  const chain = (sequence) => {
    const kept = [];
    for (const point of sequence) {
      while (kept.length > 1 && turn(kept.at(-2), kept.at(-1), point) <= 0) kept.pop();
      kept.push(point);
    }
    return kept.slice(0, -1);
  };
  return [...chain(sorted), ...chain(sorted.toReversed())];
}

function turn(a, b, c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/** Rings, of which holes are counted inside by the even-odd rule, as a multipolygon. */
function evenOdd(rings) {
  return globalThis.polygonClipping.xor(...rings.map((ring) => [ring]));
}

/** A multipolygon's rings as ours: open, outer ones clockwise on the image, holes the other way. */
function cleaned(multipolygon) {
  return multipolygon.flatMap((polygon) => polygon.map((ring, index) => {
    const open = ring.slice(0, -1).map(([row, column]) => [row, column]);
    return clockwiseArea(open) > 0 === (index === 0) ? open : open.reverse();
  }));
}

/** Signed area in square pixels, positive where a ring runs clockwise as seen on the image. */
export function clockwiseArea(ring) {
  return 0.5 * ring.reduce((sum, [row, column], index) => {
    const [nextRow, nextColumn] = ring[(index + 1) % ring.length];
    return sum + column * nextRow - nextColumn * row;
  }, 0);
}

/**
 * The strips behind each stretch of a ring that goes one way in column, as far as `farRow`, each
 * run one way around: filled by the non-zero rule they are what the radar cannot see behind the
 * rings.
 */
export function shadowStrips(rings, farRow) {
  return rings.flatMap((ring) => stretches(ring).map((stretch) => {
    const along = stretch[0][1] < stretch.at(-1)[1] ? stretch : stretch.toReversed();
    return [...along, [farRow, along.at(-1)[1]], [farRow, along[0][1]]];
  }));
}

/** A ring as open stretches along which the column only grows or only falls. */
function stretches(ring) {
  const found = [];
  let direction = 0;
  ring.forEach((tail, index) => {
    const head = ring[(index + 1) % ring.length];
    const way = Math.sign(head[1] - tail[1]);
    if (way !== 0 && way === direction) found.at(-1).push(head);
    else if (way !== 0) found.push([tail, head]);
    direction = way;
  });
  return found;
}

/** Points, without those nearer than `step` frame pixels to the one before. */
export function thinned(points, step) {
  const kept = [points[0]];
  for (const point of points.slice(1)) if (between(point, kept.at(-1)) >= step) kept.push(point);
  return kept;
}

export function middleOf(first, second) {
  return [(first[0] + second[0]) / 2, (first[1] + second[1]) / 2];
}

export function between(first, second) {
  return Math.hypot(first[0] - second[0], first[1] - second[1]);
}

const modulo = (value, size) => ((value % size) + size) % size;
