// A plane of feelings, valence across and arousal up, and where a face lies on it.

/** A point of the plane; each from -1 to 1. */
export interface Feeling {
  valence: number;
  arousal: number;
}

/** A recipe of an expression, and where it lies. */
export interface Place extends Feeling {
  name: string;
  /** How much in command one feels, -1 to 1: the third axis, which a plane does not show. */
  dominance: number;
  /** Feelings are mixed of those that are. */
  anchor: boolean;
}

/** From nearer than this a place is the place itself. */
const LEAST_DISTANCE = 1e-3;

/**
 * The dominance that goes with a point of the plane: at a place its own, and smooth in between.
 * Without it fear and anger, neighbours on the plane, could not be told apart, nor any be reached.
 */
export function dominanceAt({ valence, arousal }: Feeling, places: readonly Place[]): number {
  let sum = 0;
  let all = 0;
  for (const place of places.filter(({ anchor }) => anchor)) {
    const away = Math.hypot(place.valence - valence, place.arousal - arousal);
    const weight = Math.max(away, LEAST_DISTANCE) ** -2;
    sum += weight * place.dominance;
    all += weight;
  }
  return all > 0 ? Math.round((100 * sum) / all) / 100 : 0;
}

/** Keep a point on the plane, in steps that a command need not say more finely than. */
export function onPlane(valence: number, arousal: number): Feeling {
  const held = (value: number): number => Math.round(100 * Math.min(1, Math.max(-1, value))) / 100;
  return { valence: held(valence), arousal: held(arousal) };
}

/** Where a mixture lies that somebody else asked for: the middle of its recipes, by their weights. */
export function middleOf(
  parts: readonly { recipe: string; weight: number }[],
  places: readonly Place[],
): Feeling | null {
  const known = parts.flatMap(({ recipe, weight }) => {
    const place = places.find(({ name }) => name === recipe);
    return place === undefined ? [] : [{ place, weight }];
  });
  const all = known.reduce((sum, { weight }) => sum + weight, 0);
  if (all <= 0) return null;
  const mean = (axis: 'valence' | 'arousal'): number =>
    known.reduce((sum, { place, weight }) => sum + place[axis] * weight, 0) / all;
  return onPlane(mean('valence'), mean('arousal'));
}
