// A muscle as the moving face carries it: bone ends where the jaw has taken them, skin ends where the skin has gone. All in mm, head frame.

import { evenAround } from '../around';
import type { Carrier } from '../ground';
import type { Fibre, MuscleForm, Point } from '../muscle-shape';
import { minus, plus } from '../vector';
import type { Handle, Ray } from './editing';
import { handlesOf, led, zoneOf } from './editing';

/** A handle, and where it is drawn on the face as it stands. */
export interface CarriedHandle extends Handle {
  drawn: Point;
}

/** Its handles: `place` on the face at rest, which edits are of, `drawn` on the face as it is. */
export function carriedHandles(muscle: MuscleForm, by: Carrier): CarriedHandle[] {
  if (isRing(muscle)) {
    const onRing = endsOf(muscle, by);
    return handlesOf(muscle).map((handle) => ({
      ...handle,
      drawn: onRing[handle.id] ?? gone(handle.place, by),
    }));
  }
  const drawn = handlesOf(carried(muscle, by));
  return handlesOf(muscle).map((handle, at) => ({ ...handle, drawn: drawn[at]!.place }));
}

/** The lines that show where it acts, on the face as it is. */
export function carriedZone(muscle: MuscleForm, by: Carrier): Point[][] {
  if (!isRing(muscle)) return zoneOf(carried(muscle, by));
  const [ring, ...lines] = zoneOf(muscle);
  return [around(ring!, by), ...lines.map((line) => line.map((point) => gone(point, by)))];
}

/** The points of one of its fibres, on the face as it is. */
export function carriedFibre({ points, follows, rides, spread }: Fibre, by: Carrier): Point[] {
  if (spread) return around(points, by);
  // All of a straight fibre goes with its bone, and by and by with what its skin end does besides.
  const end = points.at(-1)!;
  const { to } = by.bone(rides);
  const besides = minus(gone(end, by), to(end));
  return points.map((point, at) => plus(to(point), besides, follows[at]!));
}

/** What it becomes at rest when the handle of a line or an arc, where that is drawn, is led by a ray. */
export function ledAsCarried(
  muscle: MuscleForm,
  id: string,
  ray: Ray,
  by: Carrier,
): Partial<MuscleForm> {
  if (!isRing(muscle)) return led(carried(muscle, by), id, ray, muscle);
  const { place, drawn } = carriedHandles(muscle, by).find((each) => each.id === id)!;
  return led(muscle, id, { ...ray, origin: minus(ray.origin, minus(drawn, place)) });
}

/** Where what is drawn at a place, along with a handle, lies on the face at rest. */
export function atRest(
  muscle: MuscleForm,
  handle: CarriedHandle,
  place: Point,
  by: Carrier,
): Point {
  if (handle.along === 'bone') return by.bone(muscle.jaw_share ?? 0).from(place);
  return plus(place, minus(handle.place, handle.drawn));
}

function isRing({ kind }: MuscleForm): boolean {
  return kind === 'sphincter';
}

/** Where the ends of a ring's axes are on the ring as it is drawn. */
function endsOf(muscle: MuscleForm, by: Carrier): Partial<Record<string, Point>> {
  const ring = around(zoneOf(muscle)[0]!, by);
  return { semi_major: ring[0]!, semi_minor: ring[(ring.length - 1) / 4]! };
}

/** A closed line of points, each with the skin over it, and all of them evenly. */
function around(points: readonly Point[], by: Carrier): Point[] {
  const ways = evenAround(Float64Array.from(points.flatMap((point) => by.skin(point))));
  return points.map((point, at) =>
    plus(point, [ways[3 * at]!, ways[3 * at + 1]!, ways[3 * at + 2]!]),
  );
}

function carried(muscle: MuscleForm, by: Carrier): MuscleForm {
  const { attachment, insertion, jaw_share: share = 0 } = muscle;
  if (attachment === undefined || insertion === undefined) return muscle;
  const { to } = by.bone(share);
  return {
    ...muscle,
    attachment: each(attachment, to),
    insertion: each(insertion, (end) => gone(end, by)),
  };
}

/** An end of a muscle, which is a point or a line of them, somewhere else. */
function each(ends: Point | readonly Point[], to: (end: Point) => Point): Point | Point[] {
  return isLine(ends) ? ends.map(to) : to(ends);
}

function isLine(ends: Point | readonly Point[]): ends is readonly Point[] {
  return Array.isArray(ends[0]);
}

function gone(place: Point, by: Carrier): Point {
  return plus(place, by.skin(place));
}
