import { describe, expect, it } from 'vitest';
import { strandSides } from '../src/strand-sides';

/** Two strands of two points each: a pair 2 wide along x or y, and a tip. */
const POSITIONS = [-1, 0, 0, 1, 0, 0, 0, 0, 5, 3, -1, 0, 3, 1, 0, 3, 0, 5];
const INDEX = [0, 1, 2, 3, 4, 5];

describe('strandSides', () => {
  it('points from the middle of a ribbon to its right side, and says which side a vertex is on', () => {
    const sides = strandSides(POSITIONS, INDEX);
    expect([...sides.slice(0, 8)]).toEqual([1, 0, 0, -1, 1, 0, 0, 1]);
    expect([...sides.slice(12, 20)]).toEqual([0, 1, 0, -1, 0, 1, 0, 1]);
  });

  it('leaves tips where they are, and as faint as what they end', () => {
    const sides = strandSides(POSITIONS, INDEX);
    expect([...sides.slice(8, 12)]).toEqual([1, 0, 0, 0]);
    expect([...sides.slice(20, 24)]).toEqual([0, 1, 0, 0]);
  });

  it('takes triangles of one ribbon together', () => {
    const long = [-1, 0, 0, 1, 0, 0, -0.5, 0, 1, 0.5, 0, 1, 0, 0, 2];
    const sides = strandSides(long, [0, 1, 2, 2, 1, 3, 2, 3, 4]);
    expect([...sides.slice(8, 20)]).toEqual([0.5, 0, 0, -1, 0.5, 0, 0, 1, 0.5, 0, 0, 0]);
  });
});
