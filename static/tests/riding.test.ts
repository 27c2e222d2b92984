// Where the jaw carries bone: as the engine has it, and back.

import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { BufferAttribute, BufferGeometry } from 'three';
import { describe, expect, it } from 'vitest';
import { Skull } from '../src/inside/skull';
import type { JawPose } from '../src/riding';
import { rideOf, SHUT, STAY } from '../src/riding';
import type { Point } from '../src/vector';

interface Golden extends JawPose {
  share: number;
  place: Point;
  carried: Point;
}

const FILE = fileURLToPath(new URL('../../tests/golden/rides.json', import.meta.url));
const GOLDEN = JSON.parse(readFileSync(FILE, 'utf8')) as Golden[];

function expectNear(found: Point, wanted: Point): void {
  found.forEach((value, axis) => {
    expect(value).toBeCloseTo(wanted[axis]!, 3);
  });
}

describe('rideOf', () => {
  it('carries as the engine does, and takes back to where it was', () => {
    expect(GOLDEN.length).toBeGreaterThan(6);
    for (const { share, place, carried, ...jaw } of GOLDEN) {
      const { to, from } = rideOf(jaw, share);
      expectNear(to(place), carried);
      expectNear(from(carried), place);
    }
  });

  it('leaves all where it is while the jaw is shut, and what does not ride', () => {
    const open = GOLDEN.find(({ quaternion }) => quaternion[0] > 0.2)!;
    expect(rideOf(SHUT, 1)).toBe(STAY);
    expect(rideOf(open, 0)).toBe(STAY);
    expect(rideOf(open, 0.5)).not.toBe(STAY);
  });
});

describe('Skull', () => {
  const { place, carried, share, ...jaw } = GOLDEN.find(
    (each) => each.share === 1 && each.quaternion[0] > 0.2,
  )!;
  // A triangle of which one corner rides the jaw.
  const bone = new BufferGeometry();
  const places = [0, 0, 0.1, 0.01, 0, 0.1, ...place.map((value) => value / 1000)];
  bone.setAttribute('position', new BufferAttribute(new Float32Array(places), 3));
  bone.setAttribute('_jaw', new BufferAttribute(new Float32Array([0, 0, share]), 1));

  it('is touched as the jaw stands, and tells where that is at rest', () => {
    const skull = new Skull(bone);
    skull.stand(jaw);
    const now = skull.mesh.geometry.getAttribute('position');
    const at = (point: number): Point => [
      1000 * now.getX(point),
      1000 * now.getY(point),
      1000 * now.getZ(point),
    ];
    expectNear(at(2), carried);
    expectNear(at(1), [10, 0, 100]);
    const under = skull.under({ corners: [0, 1, 2], weights: [0, 0.25, 0.75] });
    expect(under.share).toBeCloseTo(0.75);
    expectNear(under.place, [
      0.25 * 10 + 0.75 * place[0],
      0.75 * place[1],
      0.25 * 100 + 0.75 * place[2],
    ]);
    skull.stand(SHUT);
    expectNear(at(2), place);
    skull.dispose();
  });
});
