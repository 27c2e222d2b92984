// Curvature and thinness of forms that are known: a plane and a sphere.

import { SphereGeometry } from 'three';
import { describe, expect, it } from 'vitest';
import { mouthWalls, skinForm } from '../src/skin-form';

describe('skinForm', () => {
  it('finds a sphere s curvature, and its sign', () => {
    const sphere = new SphereGeometry(0.05, 48, 24);
    const positions = sphere.getAttribute('position').array;
    const normals = sphere.getAttribute('normal').array;
    const index = sphere.getIndex()!.array;
    const outside = skinForm({ positions, normals, index }, null, []);
    const inside = skinForm({ positions, normals: normals.map((n) => -n), index }, null, []);
    const middle = (positions.length / 3) >> 1;
    expect(outside[middle * 2]).toBeCloseTo(1 / 50, 4);
    expect(inside[middle * 2]).toBeCloseTo(-1 / 50, 4);
  });

  it('is thin where an ear bends, and not in the flat skin around it', () => {
    const plane = {
      positions: [0, 0, 0, 0.001, 0, 0, 0, 0.001, 0, 0.001, 0.001, 0],
      normals: [0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1],
      index: [0, 1, 2, 2, 1, 3],
    };
    expect([...skinForm(plane, [1, 1, 1, 1], ['cheek', 'ear'])]).toEqual(Array(8).fill(0));
    const ball = new SphereGeometry(0.005, 24, 12);
    const positions = ball.getAttribute('position').array;
    const surface = {
      positions,
      normals: ball.getAttribute('normal').array,
      index: ball.getIndex()!.array,
    };
    const regions = new Uint16Array(positions.length / 3);
    expect(skinForm(surface, regions, ['ear'])[1]).toBeCloseTo(0.8, 3);
    expect(skinForm(surface, regions, ['cheek'])[1]).toBe(0);
  });
});

describe('mouthWalls', () => {
  it('tells the walls of the mouth from the lips', () => {
    expect([...mouthWalls([0, 1, 2], ['lower_lip', 'mouth_inner', 'chin'], 3)]).toEqual([0, 1, 0]);
    expect([...mouthWalls(null, [], 2)]).toEqual([0, 0]);
  });
});
