// What the panels can ask for. main.ts does it; the panels know no network and no drawing.

import type { ViewName } from '../url';

export interface Actions {
  setActionUnit(name: string, value: number): void;
  setMuscle(name: string, activation: number): void;
  setJaw(axis: string, degrees: number): void;
  setGaze(axis: string, degrees: number): void;
  setHead(axis: string, degrees: number): void;
  /** Play an emotion, or change how strong the one that plays is. */
  playEmotion(label: string, intensity: number): void;
  stopEmotion(): void;
  setTissue(path: readonly string[], value: number): void;
  setMuscleField(muscle: string, field: string, value: number): void;
  /** Open a new session on another rig. */
  switchRig(rig: string): void;
  setView(view: ViewName): void;
  /** Let go of every control. */
  reset(): void;
  /** Leave the pause between attempts and connect now. */
  reconnect(): void;
}
