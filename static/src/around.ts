// How a ring of muscle goes with the skin under it: evenly all around, though two points of it may be tied to different lips.

/** Numbers of a point. */
const XYZ = 3;
/** Each evens every point with its two neighbours; so many reach about a twelfth of a ring of 48 steps to either side. */
const TIMES = 24;

/**
 * Even out ways, in place.
 * @param ways of the points of a closed line, x y z after x y z; the last point is the first again.
 */
export function evenAround(ways: Float64Array): Float64Array {
  const points = ways.length / XYZ - 1;
  if (points < 3) return ways;
  const before = new Float64Array(points * XYZ);
  for (let time = 0; time < TIMES; time++) {
    before.set(ways.subarray(0, points * XYZ));
    for (let at = 0; at < points; at++) {
      const last = XYZ * ((at + points - 1) % points);
      const next = XYZ * ((at + 1) % points);
      for (let axis = 0; axis < XYZ; axis++) {
        const here = XYZ * at + axis;
        ways[here] = 0.5 * before[here]! + 0.25 * (before[last + axis]! + before[next + axis]!);
      }
    }
  }
  ways.copyWithin(points * XYZ, 0, XYZ);
  return ways;
}
