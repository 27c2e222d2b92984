// Which way each strand of hair is wide: the shader widens strands that are thinner than a pixel.

/**
 * Half of each strand vertex's ribbon, with the side the vertex lies on: x y z [m], then -1, 1, or 0 for a tip.
 *
 * A strand is a run of vertices in pairs across the ribbon, and one at the tip; its triangles follow one another.
 */
export function strandSides(positions: ArrayLike<number>, index: ArrayLike<number>): Float32Array {
  const sides = new Float32Array((positions.length / 3) * 4);
  for (const [first, last] of strandRuns(index)) {
    for (let vertex = first; vertex < last; vertex++) {
      const left = vertex - ((vertex - first) % 2);
      setHalf(sides, vertex, positions, left);
      sides[vertex * 4 + 3] = vertex === left ? -1 : 1;
    }
    // The tip has no partner: it is as thin, in pixels, as the pair before it.
    setHalf(sides, last, positions, last - 2);
  }
  return sides;
}

/** First and last vertex of each strand. */
export function strandRuns(index: ArrayLike<number>): [number, number][] {
  const found: [number, number][] = [];
  for (let at = 0; at < index.length; at += 3) {
    const corners = [index[at]!, index[at + 1]!, index[at + 2]!];
    const open = found.at(-1);
    if (open === undefined || Math.min(...corners) > open[1]) {
      found.push([Math.min(...corners), Math.max(...corners)]);
    } else open[1] = Math.max(...corners);
  }
  return found;
}

function setHalf(
  sides: Float32Array,
  vertex: number,
  positions: ArrayLike<number>,
  left: number,
): void {
  for (let axis = 0; axis < 3; axis++) {
    sides[vertex * 4 + axis] =
      (positions[(left + 1) * 3 + axis]! - positions[left * 3 + axis]!) / 2;
  }
}
