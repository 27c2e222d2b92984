// The section of peeled layers joins what is left of the skin to the sheet that is seen.

import { describe, expect, it } from 'vitest';
import { Section } from '../src/inside/section';

/** Two triangles that make a square, on two sheets one under the other: x across, z deep. */
const ACROSS = [0, 2, 2, 0];
const TRIANGLES = [0, 1, 2, 0, 2, 3];
const SQUARE = [0, 0, 2, 0, 2, 2, 0, 2];
const PLACES = [0, -1].flatMap((z) =>
  ACROSS.flatMap((_, at) => [SQUARE[2 * at]!, SQUARE[2 * at + 1]!, z]),
);

function bands(cut: number): number[][] {
  const section = new Section(ACROSS, TRIANGLES, [0, 1, 2, 3], ['#ff0000']);
  section.show(1, cut);
  section.move(PLACES);
  const places = section.mesh.geometry.getAttribute('position').array;
  return Array.from({ length: places.length / 3 }, (_, at) => [
    ...places.slice(3 * at, 3 * at + 3),
  ]);
}

describe('the section of layers', () => {
  it('stands along the cut, from sheet to sheet, without a gap', () => {
    const along = bands(0.5).filter(([x]) => x === 0.5);
    expect(new Set(along.map(([, , z]) => z))).toEqual(new Set([0, -1]));
    const heights = along.map(([, y]) => y!);
    expect([Math.min(...heights), Math.max(...heights)]).toEqual([0, 2]);
    // Both pieces of it meet where they share an edge.
    expect(heights.filter((y) => y === 0.5).length).toBeGreaterThan(1);
  });

  it('goes along what of the border lies beyond the cut, and begins at it', () => {
    const places = bands(0.5);
    expect(Math.min(...places.map(([x]) => x!))).toBe(0.5);
    expect(places.filter(([x, y]) => x === 2 && y === 0)).not.toHaveLength(0);
    expect(places.filter(([x, y]) => x === 0.5 && y === 0)).not.toHaveLength(0);
  });

  it('has nothing to show without a sheet', () => {
    const section = new Section(ACROSS, TRIANGLES, [0, 1, 2, 3], ['#ff0000']);
    section.show(0, 0);
    expect(section.mesh.visible).toBe(false);
  });
});
