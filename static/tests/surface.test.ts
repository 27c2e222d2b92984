// The sparse map and the lid projection at points computed by hand.

import { describe, expect, it } from 'vitest';
import type { Eyeball, LidContact, SparseMap } from '../src/surface';
import { DrawnSurface } from '../src/surface';

const NO_LIDS: LidContact = {
  vertices: new Uint16Array(),
  eyes: new Uint16Array(),
  clearance: new Float32Array(),
};

/** Three drawn vertices on two points: the first, half of each, the second. */
const MAP: SparseMap = {
  indptr: new Uint32Array([0, 1, 3, 4]),
  indices: new Uint16Array([0, 0, 1, 1]),
  weights: new Float32Array([1, 0.5, 0.5, 1]),
  columns: 2,
};
const REST = new Float32Array([0, 0, 0, 1, 0, 0, 2, 0, 0]);

function rounded(values: Float32Array): number[] {
  return [...values].map((value) => Math.round(value * 1e6) / 1e6);
}

describe('the map', () => {
  it('adds the weighted displacements of its row', () => {
    const surface = new DrawnSurface(REST, MAP, NO_LIDS, []);
    surface.apply([0, 1], [10, 0, 0, 0, 20, -20], 0.1);
    expect(rounded(surface.positions)).toEqual([1, 0, 0, 1.5, 1, -1, 2, 2, -2]);
  });

  it('marks only what moved, and takes points that are no longer named back to rest', () => {
    const surface = new DrawnSurface(REST, MAP, NO_LIDS, []);
    surface.apply([0], [10, 0, 0], 0.1);
    expect([...surface.dirty]).toEqual([1, 1, 0]);
    expect(surface.displacement(0)).toEqual([1, 0, 0]);
    expect(surface.apply([0], [10, 0, 0], 0.1)).toBe(false);
    surface.apply([1], [0, 0, 5], 0.1);
    expect([...surface.dirty]).toEqual([1, 1, 1]);
    expect(rounded(surface.positions)).toEqual([0, 0, 0, 1, 0, 0.25, 2, 0, 0.5]);
  });
});

describe('the lid projection', () => {
  const eye: Eyeball = {
    center: [0, 0, 0],
    radius: 12,
    bulge: 1.25,
    bulgeRadius: 6.6,
    bulgePower: 1.2,
  };
  const identity: SparseMap = {
    indptr: new Uint32Array([0, 1]),
    indices: new Uint16Array([0]),
    weights: new Float32Array([1]),
    columns: 1,
  };
  const lid: LidContact = {
    vertices: new Uint16Array([0]),
    eyes: new Uint16Array([0]),
    clearance: new Float32Array([0.5]),
  };

  function moved(x: number, y: number, z: number): number[] {
    const surface = new DrawnSurface(new Float32Array([0, 0, 20]), identity, lid, [eye]);
    surface.apply([0], [x, y, z - 20], 1);
    return rounded(surface.positions);
  }

  it('lifts a vertex over the pole of the cornea', () => {
    expect(moved(0, 0, 10)).toEqual([0, 0, 13.75]);
  });

  it('keeps the clearance of the ball outside the cornea, along the ray from the centre', () => {
    // rho = 8 is beyond the bulge; |(8, 0, 6)| = 10 grows to 12.5.
    expect(moved(8, 0, 6)).toEqual([10, 0, 7.5]);
  });

  it('counts part of the bulge on its slope', () => {
    // rho = 3.3, half of the bulge radius: 1.25 (1 - 1/4)^1.2 = 0.885085 (by hand).
    const [x, , z] = moved(3.3, 0, 4.4);
    expect(Math.hypot(x!, z!)).toBeCloseTo(13.385, 3);
    expect(x! / z!).toBeCloseTo(3.3 / 4.4, 5);
  });

  it('leaves alone what is outside, and what is behind the centre', () => {
    expect(moved(0, 0, 14)).toEqual([0, 0, 14]);
    expect(moved(0, 5, -3)).toEqual([0, 5, -3]);
  });
});
