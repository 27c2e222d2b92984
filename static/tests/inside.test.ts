// What the inside shows, as numbers: strain of elements, ways of points, colours, and the bytes of layers.

import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { describe, expect, it } from 'vitest';
import { decodeLayers } from '../src/inside/layers-frame';
import { gradientOf, rampColor, rampTexels, timeColor } from '../src/inside/ramp';
import { Strains } from '../src/inside/strain';
import { Trail } from '../src/inside/trail';

const LAYERS = fileURLToPath(new URL('../../tests/golden/layers/four-nodes', import.meta.url));

describe('Strains', () => {
  // Two triangles that make a square of 10 mm, askew in space.
  const rest = [0, 0, 0, 0.01, 0, 0, 0.01, 0.008, 0.006, 0, 0.008, 0.006];
  const strains = new Strains(rest, [0, 1, 2, 0, 2, 3]);
  const moved = (along: (at: number[]) => number[]): number[] =>
    [0, 1, 2, 3].flatMap((p) => along(rest.slice(3 * p, 3 * p + 3)));

  it('is nothing at rest, and where all moves and turns together', () => {
    const turned = moved(([x, y, z]) => [-y! - x! + 0.1, x! - y!, z! - z!]);
    for (const displaced of [moved(() => [0, 0, 0]), turned]) {
      const { stretch, press } = strains.of(displaced);
      expect(Math.max(...stretch, ...press)).toBeLessThan(1e-6);
    }
  });

  it('tells stretch and press of one element apart, as shares of length', () => {
    const { stretch, press } = strains.of(moved(([x, y, z]) => [0.2 * x!, -0.1 * y!, -0.1 * z!]));
    for (const value of stretch) expect(value).toBeCloseTo(0.2, 5);
    for (const value of press) expect(value).toBeCloseTo(0.1, 5);
  });

  it('weighs the elements around a point by area, and leaves out what has none', () => {
    const folded = new Strains([...rest, 0.02, 0, 0], [0, 1, 2, 0, 2, 3, 0, 1, 4]);
    const { stretch } = folded.of([...moved(() => [0, 0, 0]), 0.01, 0, 0]);
    expect(Math.max(...stretch)).toBe(0);
  });
});

describe('Trail', () => {
  const at = (x: number): Float32Array => Float32Array.from([x, 0, 0, 0, 0, 0]);

  it('has the ways of what moved, from early to late', () => {
    const trail = new Trail(2);
    for (let tick = 0; tick <= 60; tick++) trail.add(tick, at(tick * 1e-4));
    const { point, moved, late, seconds } = trail.ways(1e-3);
    expect(new Set(point)).toEqual(new Set([0]));
    expect(seconds).toBeCloseTo(1);
    expect([late[0], late.at(-1)]).toEqual([0, 1]);
    expect(moved.at(-3)).toBeCloseTo(6e-3);
    expect(late.length).toBeLessThanOrEqual(2 * 48);
  });

  it('forgets what is longer ago, the gesture before, and another face', () => {
    const trail = new Trail(1);
    for (let tick = 0; tick <= 600; tick += 10) trail.add(tick, at(tick * 1e-4));
    expect(trail.ways(0).seconds).toBeCloseTo(1);
    trail.begin();
    expect(trail.ways(0).seconds).toBe(0);
    trail.add(620, at(0));
    expect(trail.ways(0).seconds).toBeCloseTo(20 / 60);
    trail.add(3, at(0));
    expect(trail.ways(0).point).toHaveLength(0);
    trail.forget();
    expect(trail.ways(0).seconds).toBe(0);
  });
});

describe('the ramp', () => {
  it('gets lighter all the way, and stays at its ends', () => {
    const light = ([red, green, blue]: number[]): number =>
      0.2126 * red! + 0.7152 * green! + 0.0722 * blue!;
    const lights = Array.from({ length: 40 }, (_, step) => light(rampColor(step / 39)));
    expect([...lights].sort((one, other) => one - other)).toEqual(lights);
    expect(rampColor(-1)).toEqual(rampColor(0));
    expect(rampColor(7)).toEqual(rampColor(1));
    expect([...rampTexels(3)].slice(8)).toEqual([...rampColor(1), 255]);
    expect(gradientOf(rampColor)).toContain(`rgb(${rampColor(0).join(' ')})`);
  });

  it('goes from blue to red with time', () => {
    const [[red, , blue], [later, , less]] = [timeColor(0), timeColor(1)];
    expect(blue).toBeGreaterThan(red);
    expect(later).toBeGreaterThan(less);
  });
});

describe('decodeLayers', () => {
  it('reads what the service wrote', () => {
    const said = JSON.parse(readFileSync(`${LAYERS}.json`, 'utf8')) as {
      tick: number;
      nodes: number;
      displacements: number[][][];
    };
    const read = decodeLayers(new Uint8Array(readFileSync(`${LAYERS}.bin`)).buffer);
    expect([read.tick, read.nodes]).toEqual([said.tick, said.nodes]);
    said.displacements.flat(2).forEach((value, index) => {
      expect(read.displacements[index]).toBeCloseTo(value, 7);
    });
  });

  it.each([
    new ArrayBuffer(4),
    new Uint8Array([16, 2, 0, 0, 0, 0, 0, 0]).buffer,
    new Uint8Array([16, 1, 1, 0, 0, 0, 0, 0]).buffer,
  ])('refuses other bytes', (bytes) => {
    expect(() => decodeLayers(bytes)).toThrow('another form');
  });
});
