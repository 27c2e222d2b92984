// What the visitor sees of the inside of the face, as one reactive object.

import type { MuscleForm } from '../muscle-shape';

/** What the skin is coloured by; `moved` counts from the moment that is held, or from rest. */
export const HEATS = ['off', 'stretch', 'press', 'moved'] as const;
export type Heat = (typeof HEATS)[number];

/** Who stands beside the face. */
export const BESIDES = ['off', 'held', 'paper'] as const;
export type Beside = (typeof BESIDES)[number];

export interface Scale {
  title: string;
  /** Of the numbers shown. */
  unit: string;
  /** Amount that the last colour stands for; more has it too. */
  most: number;
}

/** Colours of the skin and what they stand for. */
export const SCALES: Record<Exclude<Heat, 'off'>, Scale> = {
  stretch: { title: 'Stretched', unit: '%', most: 30 },
  press: { title: 'Pressed together', unit: '%', most: 30 },
  moved: { title: 'Moved', unit: 'mm', most: 10 },
};

/** What the skin is peeled to. */
export const PEELS = ['Skin', 'Epidermis', 'Dermis', 'Hypodermis', 'Bone'] as const;
/** Where the cut may stand, mm to the face's left. */
export const CUT_LIMIT = 90;

export class InsideState {
  heat = $state<Heat>('off');
  /** Greatest amount on the face now, in the unit of the scale. */
  greatest = $state(0);
  /** Number in `PEELS`. */
  peel = $state(0);
  /** Skin stays to the face's right of it [mm]. */
  cut = $state(0);
  structural = $state(true);
  shear = $state(true);
  trails = $state(false);
  /** How far back ways go [s], and how far they do now. */
  seconds = $state(4);
  span = $state(0);
  beside = $state<Beside>('off');
  /** Who was asked to stand beside the face does. */
  arrived = $state(false);
  /** A moment is held. */
  held = $state(false);
  /** Forms of all muscles that have one, with what was changed here. */
  forms = $state.raw<Record<string, MuscleForm>>({});
  /** The muscle that is edited; empty for none. */
  muscle = $state('');
  /** What is done to one side is done to the other. */
  mirrored = $state(false);
  /** Edits of muscles that can be undone. */
  edits = $state(0);
  /** Muscles that differ from those of the rig that was opened. */
  changed = $state.raw<readonly string[]>([]);
  /** Weights of the action unit that is being made. */
  weights = $state<Record<string, number>>({});
}
