// Walking around the face by keys.

import { Spherical, Vector3 } from 'three';

const STEP = (6 * Math.PI) / 180;
const NEARER = 0.9;
const WAYS: Record<string, readonly [theta: number, phi: number, radius: number]> = {
  ArrowLeft: [-STEP, 0, 1],
  ArrowRight: [STEP, 0, 1],
  ArrowUp: [0, -STEP, 1],
  ArrowDown: [0, STEP, 1],
  '+': [0, 0, NEARER],
  '=': [0, 0, NEARER],
  '-': [0, 0, 1 / NEARER],
};

/** Where a camera at `offset` from its target goes by a key; null for keys that do not move it. */
export function steppedOrbit(offset: Vector3, key: string): Vector3 | null {
  const way = WAYS[key];
  if (way === undefined) return null;
  const at = new Spherical().setFromVector3(offset);
  at.theta += way[0];
  at.phi += way[1];
  at.radius *= way[2];
  return new Vector3().setFromSpherical(at.makeSafe());
}
