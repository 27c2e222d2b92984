// A muscle as the moving face carries it: bone ends where they are, skin ends where the skin has gone. All in mm, head frame.

import type { Shift } from '../ground';
import type { Fibre, MuscleForm, Point } from '../muscle-shape';
import { minus, plus } from '../vector';
import type { Handle, Ray } from './editing';
import { handlesOf, led, zoneOf } from './editing';

/** A handle, and where it is drawn on the face as it stands. */
export interface CarriedHandle extends Handle {
  drawn: Point;
}

/** Its handles: `place` on the face at rest, which edits are of, `drawn` on the face as it is. */
export function carriedHandles(muscle: MuscleForm, shift: Shift): CarriedHandle[] {
  if (isRing(muscle))
    return handlesOf(muscle).map((handle) => ({ ...handle, drawn: gone(handle.place, shift) }));
  const drawn = handlesOf(carried(muscle, shift));
  return handlesOf(muscle).map((handle, at) => ({ ...handle, drawn: drawn[at]!.place }));
}

/** The lines that show where it acts, on the face as it is. */
export function carriedZone(muscle: MuscleForm, shift: Shift): Point[][] {
  return isRing(muscle)
    ? zoneOf(muscle).map((line) => line.map((point) => gone(point, shift)))
    : zoneOf(carried(muscle, shift));
}

/** The points of one of its fibres, on the face as it is. */
export function carriedFibre({ points, follows }: Fibre, shift: Shift): Point[] {
  // All of a straight fibre goes with its skin end; each point of a ring with the skin over it.
  if (follows[0] === 1) return points.map((point) => gone(point, shift));
  const end = shift(points.at(-1)!);
  return points.map((point, at) => plus(point, end, follows[at]!));
}

/** What it becomes at rest when the handle of a line or an arc, where that is drawn, is led by a ray. */
export function ledAsCarried(
  muscle: MuscleForm,
  id: string,
  ray: Ray,
  shift: Shift,
): Partial<MuscleForm> {
  if (!isRing(muscle)) return led(carried(muscle, shift), id, ray, muscle);
  const handle = handlesOf(muscle).find((each) => each.id === id)!;
  return led(muscle, id, { ...ray, origin: minus(ray.origin, shift(handle.place)) });
}

function isRing({ kind }: MuscleForm): boolean {
  return kind === 'sphincter';
}

function carried(muscle: MuscleForm, shift: Shift): MuscleForm {
  const { insertion } = muscle;
  if (insertion === undefined) return muscle;
  const ends = isLine(insertion)
    ? insertion.map((end) => gone(end, shift))
    : gone(insertion, shift);
  return { ...muscle, insertion: ends };
}

function isLine(ends: Point | readonly Point[]): ends is readonly Point[] {
  return Array.isArray(ends[0]);
}

function gone(place: Point, shift: Shift): Point {
  return plus(place, shift(place));
}
