// Where sheets of tissue end, and what of a skin that goes on lies inside.

import { describe, expect, it } from 'vitest';
import { farFrom, insideOf, outline } from '../src/inside/outline';
import type { Outline } from '../src/inside/outline';
import type { Point } from '../src/vector';
import { flatSkin, WIDE } from './flat-skin';

/** A square 4 wide in the middle of it. */
const RING: Point[] = [
  [2, 2, 0],
  [6, 2, 0],
  [6, 6, 0],
  [2, 6, 0],
];
const OUTLINE: Outline = { ring: RING, middle: [3.9, 4.1, 0] };

describe('the outline of a sheet', () => {
  it('goes round it, not round a hole in it', () => {
    const { positions, triangles } = flatSkin();
    const hole = (3 * WIDE + 3) * 2;
    expect(triangles.splice(hole, 3)).toHaveLength(3);
    const ring = outline({ positions, triangles });
    expect(ring).toHaveLength(4 * (WIDE - 1));
    expect(new Set(ring).size).toBe(ring.length);
    // Neighbours along it are neighbours on the skin.
    ring.forEach((point, at) => {
      const next = ring[(at + 1) % ring.length]!;
      expect([1, WIDE]).toContain(Math.abs(point - next));
    });
  });

  it('says how far inside it a vertex of the skin lies, and outside with a minus', () => {
    const inside = insideOf(OUTLINE, flatSkin(), null);
    const at = (x: number, y: number): number => inside[y * WIDE + x]!;
    expect([at(4, 4), at(3, 3), at(2, 4), at(1, 4), at(4, 8)]).toEqual([2, 1, 0, -1, -2]);
  });

  it('is not stepped over where the skin is cut along a seam', () => {
    const { positions, triangles } = flatSkin();
    // The column through the middle stands twice, and the right half has the other one.
    const same = Array.from({ length: WIDE * WIDE }, (_, vertex) => vertex);
    const twin = new Map<number, number>();
    for (let y = 0; y < WIDE; y++) {
      twin.set(y * WIDE + 4, positions.length / 3);
      same.push(y * WIDE + 4);
      positions.push(4, y, 0);
    }
    const cut = triangles.flatMap((_, corner) => {
      if (corner % 3 !== 0) return [];
      const corners = triangles.slice(corner, corner + 3);
      const right = corners.some((vertex) => vertex % WIDE > 4);
      return right ? corners.map((vertex) => twin.get(vertex) ?? vertex) : corners;
    });
    const inside = insideOf(OUTLINE, { positions, triangles: cut }, same);
    expect([3, 4, 5].map((x) => inside[4 * WIDE + x])).toEqual([1, 2, 1]);
    expect(inside[twin.get(4 * WIDE + 4)!]).toBe(2);
    expect(inside[4 * WIDE + 8]).toBe(-2);
  });

  it('is as far from a place as its nearest piece', () => {
    expect([...farFrom(RING, [4, 0, 0, 0, 4, 0, 4, 5, 0])]).toEqual([2, 2, 1]);
  });
});
