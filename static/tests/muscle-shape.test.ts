// Muscles as fibres.

import { describe, expect, it } from 'vitest';
import { fibresOn } from '../src/draped';
import type { MuscleForm } from '../src/muscle-shape';
import { fibresOf } from '../src/muscle-shape';
import { SHUT } from '../src/riding';

describe('fibresOf', () => {
  it('draws a spindle from bone to skin, thickest between, never deeper than its ends', () => {
    const fibres = fibresOf({
      name: 'zygomatic_major.L',
      kind: 'linear',
      attachment: [60, -20, 60],
      insertion: [28, -66, 90],
    });
    expect(fibres).toHaveLength(5);
    const { points, follows, radii } = fibres[2]!;
    expect([follows[0], follows.at(-1)]).toEqual([0, 1]);
    expect(points[0]).toEqual([60, -20, 60]);
    expect(radii[6]).toBeGreaterThan(3 * radii[0]!);
    const least = Math.min(Math.hypot(60, 60), Math.hypot(28, 90));
    for (const [x, , z] of points) expect(Math.hypot(x, z)).toBeGreaterThan(least - 1e-6);
  });

  it('draws a sheet from line to line', () => {
    const fibres = fibresOf({
      name: 'frontalis.L',
      kind: 'sheet',
      attachment: [
        [0, 64, 92],
        [22, 64, 88],
      ],
      insertion: [
        [0, 16, 98],
        [24, 19, 96],
      ],
    });
    expect(fibres.length).toBeGreaterThan(4);
    expect(fibres[0]!.points.at(-1)).toEqual([0, 16, 98]);
    expect(fibres.at(-1)!.points.at(-1)![0]).toBeCloseTo(24);
  });

  it('has all of a sheet in a lip go with it: it has no bone to stay on', () => {
    const fibres = fibresOf({
      name: 'orbicularis_oris_inferior.L',
      kind: 'sheet',
      attachment: [
        [0, -69, 101],
        [25, -70, 88],
      ],
      insertion: [
        [0, -80, 103],
        [25, -77, 90],
      ],
    });
    for (const { follows, spread } of fibres) {
      expect(new Set(follows)).toEqual(new Set([1]));
      expect(spread).toBe(false);
    }
  });

  it('draws rings that close, and go with the skin', () => {
    const [fibre] = fibresOf({
      name: 'orbicularis_oris',
      kind: 'sphincter',
      plane: [0, -72, 100],
      normal: [0, 0.1, 1],
      semi_major: 40,
      semi_minor: 20,
    });
    fibre!.points[0]!.forEach((value, axis) => {
      expect(fibre!.points.at(-1)![axis]).toBeCloseTo(value);
    });
    expect(new Set(fibre!.follows)).toEqual(new Set([1]));
  });

  it('has nothing to draw for lids and air', () => {
    expect(fibresOf({ name: 'levator_palpebrae.L', kind: 'lid' })).toEqual([]);
  });

  it('lays rings under the skin of a round face, and leaves other fibres', () => {
    const radius = 90;
    const rest: number[] = [];
    for (let x = -60; x <= 60; x += 3)
      for (let y = -60; y <= 60; y += 3)
        rest.push(x, y, Math.sqrt(radius ** 2 - x * x - y * y), x, y, -20);
    const ground = {
      rest: new Float32Array(rest),
      displacement: (): [number, number, number] => [0, 0, 0],
      jaw: () => SHUT,
    };
    const ring: MuscleForm = {
      name: 'orbicularis_oris',
      kind: 'sphincter',
      plane: [0, 0, 95],
      normal: [0, 0, 1],
      semi_major: 40,
      semi_minor: 20,
    };
    const flat = fibresOf(ring)[2]!.points;
    const draped = fibresOn(ring, ground)[2]!.points;
    draped.forEach(([x, y, z], at) => {
      expect([x, y]).toEqual(flat[at]!.slice(0, 2));
      expect(Math.hypot(x, y, z)).toBeGreaterThan(radius - 2);
      expect(Math.hypot(x, y, z)).toBeLessThan(radius);
    });
    const linear: MuscleForm = {
      name: 'risorius.L',
      kind: 'linear',
      attachment: [50, 0, 50],
      insertion: [20, 0, 80],
    };
    expect(fibresOn(linear, ground)).toEqual(fibresOf(linear));
  });
});
