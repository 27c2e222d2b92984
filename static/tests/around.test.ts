// A ring goes with the skin evenly.

import { describe, expect, it } from 'vitest';
import { evenAround } from '../src/around';

const STEPS = 48;
/** Ways of a closed ring, up and down by turns around what `even` says. */
const ring = (even: (angle: number) => number, zigzag: number): Float64Array =>
  Float64Array.from({ length: 3 * (STEPS + 1) }, (_, index) => {
    const at = Math.floor(index / 3) % STEPS;
    return index % 3 === 1 ? even((2 * Math.PI * at) / STEPS) + zigzag * (-1) ** at : 0;
  });

describe('a ring', () => {
  it('that goes as a whole goes so', () => {
    expect(evenAround(ring(() => 4, 0))).toEqual(ring(() => 4, 0));
  });

  it('loses its teeth and keeps its form, and stays closed', () => {
    const lower = (angle: number): number => -10 * Math.max(0, -Math.sin(angle));
    const even = evenAround(ring(lower, 3));
    const heights = even.filter((_, index) => index % 3 === 1);
    const bends = heights
      .slice(1, -1)
      .map((height, at) => heights[at]! + heights[at + 2]! - 2 * height);
    expect(Math.max(...bends.map(Math.abs))).toBeLessThan(0.6);
    expect(heights[36]).toBeLessThan(-7.5);
    expect(heights[12]).toBeGreaterThan(-1);
    expect(heights.at(-1)).toBe(heights[0]);
  });
});
