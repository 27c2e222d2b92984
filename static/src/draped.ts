// Rings of muscle on a face: an ellipse is flat, a face is not, and its fibres lie under the skin all around.

import type { Ground } from './ground';
import type { Fibre, MuscleForm } from './muscle-shape';
import { fibresOf } from './muscle-shape';
import type { Point } from './vector';
import { plus, unit } from './vector';

/** How deep fibres lie under the skin [mm]. */
const DEEP = 1;
/** Skin within about this of a fibre says how deep that runs, what is nearer more [mm]. */
const NEAR = 4;
/** Squares of that at which skin says nothing. */
const NOTHING = 7;
/** Skin so much further back than the ring is another part of the head [mm]. */
const BEHIND = 45;

/** The fibres of a muscle on a face. */
export function fibresOn(muscle: MuscleForm, ground: Ground): Fibre[] {
  const fibres = fibresOf(muscle);
  if (muscle.kind !== 'sphincter') return fibres;
  const out = unit(muscle.normal!);
  return fibres.map((fibre) => ({
    ...fibre,
    points: fibre.points.map((point) => draped(point, out, ground)),
  }));
}

/** The place under the skin over a place; `out` is the way to look for skin. */
function draped(place: Point, out: Point, { rest }: Ground): Point {
  let [height, whole] = [0, 0];
  for (let at = 0; at < rest.length; at += 3) {
    const x = rest[at]! - place[0];
    const y = rest[at + 1]! - place[1];
    const z = rest[at + 2]! - place[2];
    const over = x * out[0] + y * out[1] + z * out[2];
    const aside = (x * x + y * y + z * z - over * over) / NEAR ** 2;
    if (over < -BEHIND || aside > NOTHING) continue;
    const weight = Math.exp(-aside);
    height += weight * over;
    whole += weight;
  }
  return whole === 0 ? place : plus(place, out, height / whole - DEEP);
}
