// A unit of two sides: held as a whole or by its sides, never both. AU12 beside L12 would say two things of the left.

import type { Numbers } from './protocol';

/** What becomes of the others when one of a unit's three names is set. */
export interface Settled {
  /** To be let go. */
  dropped: string[];
  /** To be held, with its value: the sides of a whole that was taken apart. */
  held: [string, number][];
}

/** @param values what is held, by names such as `AU12`, `L12`, `R12`; `name` is about to be set. */
export function settledSides(values: Readonly<Numbers>, name: string): Settled {
  const number = name.replace(/^(AU|L|R)/, '');
  const [whole, left, right] = [`AU${number}`, `L${number}`, `R${number}`];
  if (name === whole) {
    return { dropped: [left, right].filter((side) => side in values), held: [] };
  }
  const value = values[whole];
  if (value === undefined) return { dropped: [], held: [] };
  return {
    dropped: [whole],
    held: [
      [left, value],
      [right, value],
    ],
  };
}
