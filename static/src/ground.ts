// What a face carries along: the skin that goes, and bone on the jaw, with whatever is tied to either.

import type { Face } from './face';
import type { JawPose, Ride } from './riding';
import { rideOf } from './riding';
import type { Point } from './vector';

/** What muscles and their handles are tied to. */
export interface Ground {
  /** Streamed points at rest [mm, head frame], x y z after x y z. */
  rest: Float32Array;
  /** How far a streamed point has moved [m]. */
  displacement(point: number): readonly [number, number, number];
  /** The jaw as it stands. */
  jaw(): JawPose;
}

/** How a face, as it stands, carries what is tied to it. All in mm, head frame. */
export interface Carrier {
  /** How far the skin over a place has gone from rest; the place as it is at rest. */
  skin: (place: Point) => Point;
  /** Where bone goes that rides the jaw by a share of it. */
  bone: (share: number) => Ride;
}

const MILLIMETRES = 1000;

export function groundOf(face: Face): Ground {
  return {
    rest: face.restPoints,
    displacement: (at) => face.displacement(at),
    jaw: () => face.jaw,
  };
}

/** The streamed point nearest to a place at rest [mm, head frame]. */
export function nearestPoint({ rest }: Ground, [x, y, z]: Point): number {
  let found = 0;
  let least = Infinity;
  for (let at = 0; at < rest.length; at += 3) {
    const [right, up, out] = [rest[at]! - x, rest[at + 1]! - y, rest[at + 2]! - z];
    const away = right * right + up * up + out * out;
    if (away < least) [least, found] = [away, at / 3];
  }
  return found;
}

export function carrierOf(ground: Ground): Carrier {
  return {
    skin: (place) => {
      const [x, y, z] = ground.displacement(nearestPoint(ground, place));
      return [x * MILLIMETRES, y * MILLIMETRES, z * MILLIMETRES];
    },
    bone: (share) => rideOf(ground.jaw(), share),
  };
}
