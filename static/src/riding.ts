// How the jaw carries what is tied to bone: by a share of its turn and its slide, as `JawHinge.move` of the engine does. All in mm, head frame.

import type { Point } from './vector';
import { minus, plus } from './vector';

/** The jaw as it stands. */
export interface JawPose {
  /** Where its hinge is at rest, and how far that has slid. */
  hinge: Point;
  offset: Point;
  /** Its turn about the hinge, x y z w. */
  quaternion: readonly [number, number, number, number];
}

/** Where something is carried. */
export interface Ride {
  /** Where a place of rest is now. */
  to: (place: Point) => Point;
  /** Where what is here now is at rest. */
  from: (place: Point) => Point;
}

export const SHUT: JawPose = { hinge: [0, 0, 0], offset: [0, 0, 0], quaternion: [0, 0, 0, 1] };

/** Of what stays where it is. */
export const STAY: Ride = { to: (place) => place, from: (place) => place };

/** What rides the jaw by a share of it: the angles are scaled, so that nothing shrinks towards the hinge. */
export function rideOf({ hinge, offset, quaternion }: JawPose, share: number): Ride {
  // It opens first, and then turns aside.
  const [x, y, , w] = quaternion;
  const opened = 2 * share * Math.atan(x / w);
  const aside = 2 * share * Math.atan(y / w);
  if (opened === 0 && aside === 0 && (share === 0 || Math.hypot(...offset) === 0)) return STAY;
  const there = plus(hinge, offset, share);
  return {
    to: (place) => plus(there, turnedAside(tipped(minus(place, hinge), opened), aside)),
    from: (place) => plus(hinge, tipped(turnedAside(minus(place, there), -aside), -opened)),
  };
}

function tipped([x, y, z]: Point, angle: number): Point {
  const [sin, cos] = [Math.sin(angle), Math.cos(angle)];
  return [x, cos * y - sin * z, sin * y + cos * z];
}

function turnedAside([x, y, z]: Point, angle: number): Point {
  const [sin, cos] = [Math.sin(angle), Math.cos(angle)];
  return [cos * x + sin * z, y, cos * z - sin * x];
}
