// Which way hair runs from root to tip, and how far: its highlights lie along it, and the shorter it is, the fainter.

import { strandRuns } from './strand-sides';

/**
 * Direction of growth at each vertex, and the length of what it belongs to in the unit of `positions`: x y z length
 * after x y z length.
 *
 * A strand or card is a run of vertices in pairs across it, perhaps with one at the tip; its triangles follow one
 * another.
 */
export function strandTangents(
  positions: ArrayLike<number>,
  index: ArrayLike<number>,
): Float32Array {
  const tangents = new Float32Array((positions.length / 3) * 4);
  for (const [first, last] of strandRuns(index)) {
    const rows = Math.floor((last - first) / 2) + 1;
    const line = Array.from({ length: rows }, (_, row) => middle(positions, first, last, row));
    const whole = line.reduce((sum, at, row) => sum + distance(at, line[Math.max(row - 1, 0)]!), 0);
    for (let row = 0; row < rows; row++) {
      const before = line[Math.max(row - 1, 0)]!;
      const after = line[Math.min(row + 1, rows - 1)]!;
      const length = Math.max(distance(before, after), 1e-12);
      const tangent = before.map((value, axis) => (after[axis]! - value) / length);
      for (const vertex of rowOf(first, last, row)) tangents.set([...tangent, whole], vertex * 4);
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

function distance(one: readonly number[], other: readonly number[]): number {
  return Math.hypot(...one.map((value, axis) => other[axis]! - value));
}
