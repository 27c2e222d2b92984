// What the panels can ask for. the files of app/ do it; the panels know no network and no drawing.

import type { LightName } from '../light-presets';
import type { Theme } from '../theme';
import type { ViewName } from '../views';
import type { InsideActions } from './inside-actions';

/** What a slider moves: the name of a group in a command, and a name in it. */
export type Group = 'action_units' | 'muscles' | 'jaw' | 'gaze' | 'head' | 'tongue';

export interface Actions {
  /** See inside, and take muscles in hand. */
  within: InsideActions;
  /** Intensity of an action unit, activation of a muscle, degrees of a pose axis. */
  set(group: Group, name: string, value: number): void;
  /** Hold it no longer, so that other layers show through; a value of 0 would be held. */
  letGo(group: Group, name: string): void;
  /** Play an emotion, or change how strong the one that plays is. */
  playEmotion(label: string, intensity: number): void;
  stopEmotion(): void;
  /** Play the face of a point among feelings, each -1 to 1. */
  feel(valence: number, arousal: number): void;
  /** Play a FACS string and nothing else; tells what is wrong with it, empty if nothing is. */
  setFacs(text: string): Promise<string>;
  undo(): void;
  redo(): void;
  /** Put a text on the clipboard. @param what it is, for the sentence that says so. */
  copy(text: string, what: string): void;
  /** Whether the face blinks, looks about and sways by itself. */
  setAlive(alive: boolean): void;
  setTissue(path: readonly string[], value: number): void;
  /** Give the face tissue of another age; its form stays. */
  setTissueAge(age: 'young' | 'middle' | 'old'): void;
  setMuscleField(muscle: string, field: string, value: number): void;
  /** Open a new session on another rig. */
  switchRig(rig: string): void;
  /** The same on a person made by chance. */
  meetStranger(): void;
  /** Change how the person looks, which makes another person. */
  setPerson(attribute: string, value: number | string): void;
  setView(view: ViewName): void;
  setLight(light: LightName): void;
  setTheme(theme: Theme): void;
  setTurning(turning: boolean): void;
  /** Whether the muscles are drawn over the face. */
  setInside(inside: boolean): void;
  /** Offer what is seen now as a file. */
  savePicture(): void;
  /** Put a link to this face on the clipboard. */
  copyLink(role: 'read' | 'control'): void;
  /** Begin a recording, or end it and keep the take. */
  recordTake(): void;
  /** Play the take, or pause. */
  playTake(): void;
  /** Show the face as it is in the take at a time [s]. */
  seekTake(time: number): void;
  /** Make keys of what the controls hold, at the time that is shown. */
  keyTake(): void;
  /** Give the take another length [s]; its curves keep their times. */
  stretchTake(duration: number): void;
  /** Leave out what is not between beginning and end. */
  trimTake(): void;
  exportTake(form: 'glb' | 'json'): void;
  /** Put a timeline that was saved on the timeline, or play what a tracker wrote. */
  openTake(file: File): void;
  /** Wait no longer for an export, or for a file that is read. */
  cancelTake(): void;
  /** Let go of every control. */
  reset(): void;
  /** Leave the pause between attempts and connect now. */
  reconnect(): void;
  /** Go on with a key that the visitor gave. */
  unlock(key: string): void;
}
