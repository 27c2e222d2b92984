// The face as a FACS string that can be read: what idle life does by itself is left out of it.

import type { FaceState, Numbers } from '../protocol';
import { unitNumber } from './rig';

const LETTERS = 'ABCDE';
/** Less than half of an A is not scored. */
const LEAST_SCORED = 0.1;
const SIDES = ['AU', 'L', 'R', 'T', 'B'];

/**
 * Write the action units that a face is told to play, by rising number.
 * What sliders hold is written to a hundredth, what an emotion plays in letters.
 */
export function facsOf(state: FaceState): string {
  const { action_units: units = {}, writers = {} } = state.merged ?? {};
  const held = state.layers?.puppet?.action_units ?? {};
  return Object.entries(units)
    .filter(([name]) => writers[name]?.some((layer) => layer !== 'idle') ?? true)
    .sort(([one], [other]) => order(one) - order(other))
    .map(([name, value]) => term(name, name in held ? exact(value) : letter(value)))
    .filter(Boolean)
    .join('+');
}

/** The units of a FACS string as the service read it, as a command names them. */
export function unitsOf(
  read: readonly { name: string; side: string; intensity: number }[],
): Numbers {
  return Object.fromEntries(
    read.map(({ name, side, intensity }) => [side + (side ? name.slice(2) : name), intensity]),
  );
}

function term(name: string, intensity: string): string {
  return intensity && name.replace(/^AU/, '') + intensity;
}

function exact(value: number): string {
  const fifth = value * LETTERS.length;
  if (Math.round(100 * value) === 0) return '';
  return Math.abs(fifth - Math.round(fifth)) < 0.025
    ? letter(value)
    : `:${Number(value.toFixed(2))}`;
}

function letter(value: number): string {
  const fifth = Math.min(LETTERS.length, Math.round(value * LETTERS.length));
  return value < LEAST_SCORED ? '' : LETTERS.charAt(fifth - 1);
}

function order(name: string): number {
  const side = /^[A-Z]+/.exec(name)?.[0] ?? '';
  return unitNumber(name) * SIDES.length + SIDES.indexOf(side);
}
