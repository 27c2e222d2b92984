// Hair goes with the skin that is peeled, a strand at a time.

import { BufferGeometry, Float32BufferAttribute, Mesh } from 'three';
import { describe, expect, it } from 'vitest';
import { createHollow } from '../src/inside/hollow';
import { NOTHING_PEELED, Peel } from '../src/peel';
import type { Outline } from '../src/inside/outline';
import type { Point } from '../src/vector';
import { flatSkin, WIDE } from './flat-skin';

const RING: Point[] = [
  [2, 2, 0],
  [6, 2, 0],
  [6, 6, 0],
  [2, 6, 0],
];
const OUTLINE: Outline = { ring: RING, middle: [3.9, 4.1, 0] };

function flat(): { skin: BufferGeometry; positions: number[] } {
  const { positions, triangles } = flatSkin();
  const skin = new BufferGeometry();
  skin.setIndex(triangles);
  return { skin, positions };
}

/** A strand of three vertices on each of these vertices of the skin. */
function strandsOn(roots: number[]): { geometry: BufferGeometry; roots: number[] } {
  const geometry = new BufferGeometry();
  geometry.setAttribute(
    'position',
    new Float32BufferAttribute(new Float32Array(9 * roots.length), 3),
  );
  geometry.setIndex(Array.from({ length: 3 * roots.length }, (_, at) => at));
  return { geometry, roots: roots.flatMap((root) => [root, root, root]) };
}

describe('a face that is peeled', () => {
  const at = (x: number, y: number): number => y * WIDE + x;

  it('loses the strands on what is peeled beyond the cut, and gets them back', () => {
    const hair = strandsOn([at(3, 4), at(5, 4), at(8, 4)]);
    const peel = new Peel({ ...flat(), seams: null, hair: [hair] }, OUTLINE);
    const drawn = (): number[] => [...hair.geometry.getIndex()!.array];
    peel.cutAt(4);
    expect(drawn()).toEqual([0, 1, 2, 6, 7, 8]);
    peel.cutAt(-100);
    expect(drawn()).toEqual([6, 7, 8]);
    peel.cutAt(NOTHING_PEELED);
    expect(drawn()).toEqual([0, 1, 2, 3, 4, 5, 6, 7, 8]);
  });

  it('tells its skin how far inside the border and how far to the left each vertex lies', () => {
    const face = flat();
    new Peel({ ...face, seams: null, hair: [] }, OUTLINE);
    const peeling = face.skin.getAttribute('peeling');
    expect([peeling.getX(at(4, 4)), peeling.getY(at(4, 4))]).toEqual([2, 4]);
    expect(peeling.getX(at(0, 4))).toBe(-2);
  });
});

describe('the inner side of the skin', () => {
  it('is not drawn before something is peeled', () => {
    const skin = new Mesh(flat().skin);
    const hollow = createHollow({ skin, peelCut: { value: NOTHING_PEELED }, neckFade: null });
    expect([hollow.visible, hollow.geometry === skin.geometry]).toEqual([false, true]);
  });
});
