// Directions in the target frame: what they are called, where they lie on a map, what views see.

const AXES = ["x along-track", "y cross-track", "z nadir"];
const NEARLY = 0.95;
const DEGREES = 180 / Math.PI;
const STEPS = 24;

/** "nearly y cross-track", "between x along-track and z nadir". */
export function nearestAxis(direction) {
  const order = [0, 1, 2].sort((a, b) => Math.abs(direction[b]) - Math.abs(direction[a]));
  const [first, second] = order.map((axis) => AXES[axis]);
  if (Math.abs(direction[order[0]]) >= NEARLY) return `nearly ${first}`;
  return `between ${first} and ${second}`;
}

/** Where a direction lies on the equal-area disc of radius 1: z in the middle, x up, y right.
 *
 * Opposite directions lie at the same place (Lambert, 1772, folded at the rim).
 */
export function onDisc([x, y, z]) {
  const sign = z < 0 ? -1 : 1;
  const across = Math.hypot(x, y);
  if (across === 0) return [0, 0];
  const radius = Math.sqrt(1 - Math.min(Math.abs(z), 1));
  return [(sign * y * radius) / across, (-sign * x * radius) / across];
}

/** The direction at a place on that disc, null outside it. */
export function fromDisc(right, down) {
  const square = right * right + down * down;
  if (square > 1) return null;
  const z = 1 - square;
  const stretch = square === 0 ? 0 : Math.sqrt((1 - z * z) / square);
  return [-down * stretch, right * stretch, z];
}

/** Degrees between a direction and the nearest of the image planes whose normals are `blind`.
 * @param {number[]} direction
 * @param {number[][]} blind
 */
export function degreesFromPlanes(direction, blind) {
  const [x, y, z] = direction;
  let least = 1;
  for (const [a, b, c] of blind) least = Math.min(least, Math.abs(a * x + b * y + c * z));
  return Math.asin(least) * DEGREES;
}

/** The direction farthest from every image plane, and how far; null without views. */
export function leastSeen(blind) {
  if (blind.length === 0) return null;
  let worst = null;
  for (let row = -STEPS; row <= STEPS; row += 1) {
    for (let column = STEPS; column >= -STEPS; column -= 1) {
      const direction = fromDisc(column / STEPS, row / STEPS);
      if (direction === null) continue;
      const degrees = degreesFromPlanes(direction, blind);
      if (worst === null || degrees > worst.degrees) worst = { direction, degrees };
    }
  }
  return worst;
}

/** θ and φ of a line of sight in degrees, as the paper counts them. */
export function angles([x, y, z]) {
  return [Math.asin(Math.max(-1, Math.min(1, z))) * DEGREES, Math.atan2(x, y) * DEGREES];
}
