// Which way hair runs from root to tip: its highlights lie along it.

import { strandRuns } from './strand-sides';

/**
 * Direction of growth at each vertex, x y z after x y z.
 *
 * A strand or card is a run of vertices in pairs across it, perhaps with one at the tip; its triangles follow one
 * another.
 */
export function strandTangents(
  positions: ArrayLike<number>,
  index: ArrayLike<number>,
): Float32Array {
  const tangents = new Float32Array(positions.length);
  for (const [first, last] of strandRuns(index)) {
    const rows = Math.floor((last - first) / 2) + 1;
    for (let row = 0; row < rows; row++) {
      const before = middle(positions, first, last, Math.max(row - 1, 0));
      const after = middle(positions, first, last, Math.min(row + 1, rows - 1));
      const grown = before.map((value, axis) => after[axis]! - value);
      const length = Math.max(Math.hypot(...grown), 1e-12);
      for (const vertex of rowOf(first, last, row)) {
        grown.forEach((value, axis) => (tangents[vertex * 3 + axis] = value / length));
      }
    }
  }
  return tangents;
}

function rowOf(first: number, last: number, row: number): number[] {
  const left = first + 2 * row;
  return left === last ? [left] : [left, left + 1];
}

function middle(positions: ArrayLike<number>, first: number, last: number, row: number): number[] {
  const vertices = rowOf(first, last, row);
  return [0, 1, 2].map(
    (axis) =>
      vertices.reduce((sum, vertex) => sum + positions[vertex * 3 + axis]!, 0) / vertices.length,
  );
}
