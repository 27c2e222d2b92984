// What the panel of the inside can ask for.

import type { MuscleForm } from '../muscle-shape';
import type { Beside, Heat } from './inside.svelte';

export interface InsideActions {
  setHeat(heat: Heat): void;
  /** @param to number in `PEELS`. */
  setPeel(to: number): void;
  /** @param x mm to the face's left. */
  setCut(x: number): void;
  setSprings(kind: 'structural' | 'shear', shown: boolean): void;
  setTrails(shown: boolean): void;
  setTrailSeconds(seconds: number): void;
  /** Keep the face as it is now, to be compared with. */
  holdMoment(): void;
  dropMoment(): void;
  setBeside(beside: Beside): void;
  /** Edit a muscle; an empty name ends that. */
  chooseMuscle(name: string): void;
  /** @param gesture what is done to it; the same again within a moment is undone with it. */
  editMuscle(change: Partial<MuscleForm>, gesture: string): void;
  undoMuscle(): void;
  resetMuscle(): void;
  /** Give the muscle a weight in the action unit that is being made; null takes it out. */
  weigh(muscle: string, weight: number | null): void;
  /** Have the face contract the muscles of the new unit by this share of their weights; 0 lets go. */
  tryUnit(share: number): void;
  /** Keep the edits, and the unit if it has a name and muscles, as a rig, and go on with that. */
  saveRig(name: string, unit: string): Promise<void>;
}
