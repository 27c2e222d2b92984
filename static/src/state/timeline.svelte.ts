// The take under the face, and where in it one is.

import type { ClipOptions } from '../clip';
import { USUAL } from '../clip';
import type { Take } from '../take';
import { EMPTY } from '../take';
import { History } from './history';

export class TimelineState {
  take = $state.raw<Take>(EMPTY);
  /** [s] */
  time = $state(0);
  /** What is played, looped and exported lies between these [s]. */
  from = $state(0);
  to = $state(EMPTY.duration);
  playing = $state(false);
  recording = $state(false);
  loop = $state(false);
  /** How far an export, or the reading of a file, is, 0 to 1; null while there is none. */
  exporting = $state<number | null>(null);
  /** How a GLB file of it is to be. */
  options = $state.raw<ClipOptions>(USUAL);
  /** How well a tracker's file could be read that is on the timeline, in sentences. */
  report = $state.raw<string[]>([]);
  canUndo = $state(false);
  private readonly history = new History<Take>();

  get empty(): boolean {
    return this.take.tracks.length === 0 && this.take.cues.length === 0;
  }

  /** Put another take in its place. */
  use(take: Take): void {
    this.note('another take');
    this.show(take);
    this.time = 0;
    this.report = [];
  }

  /** The same take, changed. @param gesture see History. */
  change(gesture: string, take: Take): void {
    this.note(gesture);
    this.take = take;
  }

  undo(): void {
    const before = this.history.undo(this.take);
    if (before !== null) this.show(before);
    this.canUndo = this.history.canUndo;
  }

  private show(take: Take): void {
    this.take = take;
    this.from = 0;
    this.to = take.duration;
    this.time = Math.min(this.time, take.duration);
  }

  private note(gesture: string): void {
    this.history.note(gesture, () => this.take);
    this.canUndo = true;
  }
}
