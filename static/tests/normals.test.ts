// Normals of a moving fan of triangles, and strands that turn with them.

import { describe, expect, it } from 'vitest';
import { MovingNormals } from '../src/normals';
import { Strands } from '../src/strands';

/** A unit square in the plane z = 0, and a far triangle that never moves. */
const POSITIONS = new Float32Array([0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 5, 0, 0, 6, 0, 0, 5, 1, 0]);
const INDEX = new Uint16Array([0, 1, 2, 0, 2, 3, 4, 5, 6]);
const UP = new Float32Array(21).map((_, i) => (i % 3 === 2 ? 1 : 0));
const MOVED = new Uint8Array([1, 1, 1, 1, 0, 0, 0]);

/** The square, turned by 90 degrees about x: (x, y, 0) becomes (x, 0, y). */
function turned(): Float32Array {
  const positions = POSITIONS.slice();
  for (let i = 0; i < 4; i++) {
    positions[i * 3 + 2] = positions[i * 3 + 1]!;
    positions[i * 3 + 1] = 0;
  }
  return positions;
}

describe('MovingNormals', () => {
  it('keeps the authored normals at rest', () => {
    const tilted = UP.map((value, i) => (i === 0 ? 0.6 : i === 2 ? 0.8 : value));
    const normals = new MovingNormals(INDEX, POSITIONS, tilted);
    normals.update(POSITIONS, MOVED);
    expect(normals.normals[0]).toBeCloseTo(0.6, 6);
    expect(normals.normals[2]).toBeCloseTo(0.8, 6);
    expect([...normals.geometric.subarray(0, 3)]).toEqual([0, 0, 1]);
  });

  it('turns with what moved and leaves the rest', () => {
    const normals = new MovingNormals(INDEX, POSITIONS, UP);
    normals.update(turned(), MOVED);
    expect([...normals.geometric.subarray(0, 3)]).toEqual([0, -1, 0]);
    expect([...normals.normals.subarray(12, 15)]).toEqual([0, 0, 1]);
  });

  it('shows no seam where vertices are doubled', () => {
    // Two triangles in a fold along x, each with its own two vertices on the fold.
    const fold = new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, -1, 0]);
    const up = new Float32Array(18).map((_, i) => (i % 3 === 2 ? 1 : 0));
    const normals = new MovingNormals(
      new Uint16Array([0, 1, 2, 4, 3, 5]),
      fold,
      up,
      [0, 1, 2, 0, 1, 5],
    );
    const bent = fold.slice();
    bent[17] = -1;
    normals.update(bent, new Uint8Array([0, 0, 0, 0, 0, 1]));
    expect([...normals.normals.subarray(9, 12)]).toEqual([...normals.normals.subarray(0, 3)]);
    expect(normals.geometric[13]).toBeCloseTo(-1 / Math.sqrt(5), 6);
    expect(normals.geometric[1]).toBe(normals.geometric[13]);
  });

  it('weighs triangles by area', () => {
    // At vertex 0 a triangle of area 1/2 faces +z and one of area 1 faces +x.
    const positions = new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 2]);
    const normals = new MovingNormals(
      new Uint16Array([0, 1, 2, 0, 3, 4]),
      positions,
      new Float32Array(15),
    );
    expect(normals.geometric[0]).toBeCloseTo(2 / Math.sqrt(5), 6);
    expect(normals.geometric[2]).toBeCloseTo(1 / Math.sqrt(5), 6);
  });
});

describe('Strands', () => {
  it('ride their root and turn with its normal', () => {
    const rest = { positions: POSITIONS, normals: UP };
    const strand = new Float32Array([1, 0, 0, 1, 0, 2, 1.5, 0, 1]);
    const strands = new Strands(strand, [1, 1, 1], rest);
    strands.update(rest);
    expect([...strands.positions]).toEqual([...strand]);
    const normals = new MovingNormals(INDEX, POSITIONS, UP);
    normals.update(turned(), MOVED);
    strands.update({ positions: turned(), normals: normals.geometric });
    expect([...strands.positions]).toEqual([1, 0, 0, 1, -2, 0, 1.5, -1, 0]);
  });
});
