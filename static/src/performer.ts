// Records what the controls do, and plays it to the face again.

import type { Numbers } from './protocol';
import type { Group } from './state/actions';
import type { TimelineState } from './state/timeline.svelte';
import type { Cue, Held, Take, Track } from './take';
import { cueAt, LEAST_STEP, poseAt, simplified } from './take';

export interface PerformerOptions {
  /** What is held now. */
  held: () => Held;
  /** Have the face be there, with all controls, within `fade` seconds. */
  pose: (pose: Record<string, Numbers>, fade: number) => void;
  /** Have this play as an emotion. */
  cue: (plays: Cue['plays']) => void;
  schedule?: (run: (now: number) => void) => void;
}

/** A face that plays is told where to be this often [s]. */
const STEP_SECONDS = 1 / 30;
/** A scrubbed face follows the hand a little behind. */
const SEEK_FADE_SECONDS = 0.12;
/** Points on a way through feelings are this far apart [s]. */
const CUE_SECONDS = 0.1;
export const LONGEST_SECONDS = 120;

export class Performer {
  /** When the running time was `base` [ms]. */
  private startedAt = 0;
  private base = 0;
  private saidAt = -Infinity;
  /** Counts recordings and playings, so that one that was left does not go on. */
  private run = 0;
  private played: string | null = null;
  private recorded = new Map<string, { track: Track; keys: { time: number; value: number }[] }>();
  private cues: Cue[] = [];
  private readonly schedule: (run: (now: number) => void) => void;

  constructor(
    private readonly state: TimelineState,
    private readonly options: PerformerOptions,
  ) {
    this.schedule = options.schedule ?? ((run) => requestAnimationFrame(run));
  }

  /** Begin a take with what is held now. */
  record(): void {
    this.state.playing = false;
    this.recorded = new Map();
    this.cues = [];
    this.state.recording = true;
    this.note(0);
    this.begin(LEAST_STEP, (time) => {
      this.note(time);
    });
  }

  /** End a recording and keep it, or stay where the playing is. */
  stop(): void {
    if (this.state.recording) this.keep();
    this.state.recording = false;
    this.state.playing = false;
  }

  play(): void {
    const { state } = this;
    if (state.time >= state.to - LEAST_STEP || state.time < state.from) state.time = state.from;
    state.playing = true;
    this.played = null;
    this.begin(state.time, (time, now) => {
      this.goOn(time, now);
    });
  }

  /** Show the face as it is at a time. */
  seek(time: number): void {
    const { state } = this;
    state.playing = false;
    state.time = Math.min(state.take.duration, Math.max(0, time));
    this.show(SEEK_FADE_SECONDS);
  }

  private begin(base: number, step: (time: number, now: number) => void): void {
    const run = ++this.run;
    this.base = base;
    this.saidAt = -Infinity;
    this.startedAt = NaN;
    const next = (now: number): void => {
      if (run !== this.run || !(this.state.recording || this.state.playing)) return;
      if (Number.isNaN(this.startedAt)) this.startedAt = now;
      step(this.base + (now - this.startedAt) / 1000, now);
      this.schedule(next);
    };
    this.schedule(next);
  }

  private goOn(time: number, now: number): void {
    const { state } = this;
    if (time >= state.to && !state.loop) {
      state.time = state.to;
      this.show(STEP_SECONDS);
      state.playing = false;
      return;
    }
    if (time >= state.to) {
      [this.base, this.startedAt, this.saidAt] = [state.from, now, -Infinity];
      this.played = null;
    }
    state.time = time >= state.to ? state.from : time;
    if (Math.abs(time - this.saidAt) < STEP_SECONDS) return;
    this.saidAt = state.time;
    this.show(STEP_SECONDS);
  }

  private show(fade: number): void {
    const { take, time } = this.state;
    if (take.tracks.length > 0) this.options.pose(poseAt(take, time), fade);
    const plays = cueAt(take.cues, time);
    const said = JSON.stringify(plays);
    if (take.cues.length > 0 && said !== this.played) this.options.cue(plays);
    this.played = said;
  }

  private note(time: number): void {
    this.state.time = time;
    const { controls, plays } = this.options.held();
    for (const [group, values] of Object.entries(controls) as [Group, Numbers][]) {
      for (const [name, value] of Object.entries(values)) this.noteValue(group, name, time, value);
    }
    for (const { track, keys } of this.recorded.values()) {
      if (!(track.name in controls[track.group])) this.addKey(keys, time, 0);
    }
    this.noteCue(time, plays);
    if (time >= LONGEST_SECONDS) this.stop();
  }

  /** A way through feelings is kept in steps that its fades join. */
  private noteCue(time: number, plays: Cue['plays']): void {
    const last = this.cues.at(-1);
    if (JSON.stringify(plays) === JSON.stringify(last?.plays ?? null)) return;
    const both = isPoint(plays) && isPoint(last?.plays ?? null);
    const joined = last !== undefined && both && time - last.time < CUE_SECONDS;
    if (joined) last.plays = plays;
    else this.cues.push({ time, plays });
  }

  private noteValue(group: Group, name: string, time: number, value: number): void {
    const id = `${group}.${name}`;
    const known = this.recorded.get(id);
    if (known !== undefined) {
      this.addKey(known.keys, time, value);
      return;
    }
    // What is held from the beginning has no way behind it; all else came from rest.
    const keys = time === 0 ? [] : [{ time: time - LEAST_STEP, value: 0 }];
    this.recorded.set(id, {
      track: { group, name, keys: [] },
      keys: [...keys, { time, value }],
    });
  }

  /** A value that stays is two keys, where it began to stay and where it goes on. */
  private addKey(keys: { time: number; value: number }[], time: number, value: number): void {
    const [last, before] = [keys.at(-1), keys.at(-2)];
    if (last?.value === value && before?.value === value) last.time = time;
    else keys.push({ time, value });
  }

  private keep(): void {
    const duration = Math.max(0.1, this.state.time);
    const tracks = [...this.recorded.values()].map(({ track, keys }) => ({
      ...track,
      keys: simplified(keys),
    }));
    this.state.use({ duration, tracks, cues: this.cues } satisfies Take);
  }
}

function isPoint(plays: Cue['plays']): boolean {
  return plays !== null && 'valence' in plays;
}
