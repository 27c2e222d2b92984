// What the panels can ask for. main.ts does it; the panels know no network and no drawing.

import type { ViewName } from '../views';

/** What a slider moves: the name of a group in a command, and a name in it. */
export type Group = 'action_units' | 'muscles' | 'jaw' | 'gaze' | 'head' | 'tongue';

export interface Actions {
  /** Intensity of an action unit, activation of a muscle, degrees of a pose axis. */
  set(group: Group, name: string, value: number): void;
  /** Hold it no longer, so that other layers show through; a value of 0 would be held. */
  letGo(group: Group, name: string): void;
  /** Play an emotion, or change how strong the one that plays is. */
  playEmotion(label: string, intensity: number): void;
  stopEmotion(): void;
  /** Whether the face blinks, looks about and sways by itself. */
  setAlive(alive: boolean): void;
  setTissue(path: readonly string[], value: number): void;
  setMuscleField(muscle: string, field: string, value: number): void;
  /** Open a new session on another rig. */
  switchRig(rig: string): void;
  /** The same on a person made by chance. */
  meetStranger(): void;
  /** Change how the person looks, which makes another person. */
  setPerson(attribute: string, value: number | string): void;
  setView(view: ViewName): void;
  /** Let go of every control. */
  reset(): void;
  /** Leave the pause between attempts and connect now. */
  reconnect(): void;
  /** Go on with a key that the visitor gave. */
  unlock(key: string): void;
}
