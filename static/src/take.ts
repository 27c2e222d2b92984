// A performance as curves: what each control does over time, and which emotions play when.

import type { Feeling } from './feelings';
import type { Group } from './state/actions';

/** A point of a curve; between two of them it runs straight. */
export interface Key {
  /** [s] from the beginning. */
  time: number;
  value: number;
}

/** What one control does. Before its first key it is where that is, after its last one as well. */
export interface Track {
  group: Group;
  name: string;
  keys: readonly Key[];
}

/** From then on this plays as an emotion, until the next one. */
export interface Cue {
  time: number;
  /** A label, a point among feelings, or null for nothing. */
  plays: { label: string; intensity: number } | (Feeling & { dominance: number }) | null;
}

export interface Take {
  /** [s] */
  duration: number;
  tracks: readonly Track[];
  cues: readonly Cue[];
}

/** What controls hold at one moment, and what plays as an emotion. */
export interface Held {
  controls: Record<Group, Record<string, number>>;
  plays: Cue['plays'];
}

export const EMPTY: Take = { duration: 4, tracks: [], cues: [] };
/** Keys nearer to each other than this are one [s]. */
export const LEAST_STEP = 1 / 60;
/** How far a simpler curve may be off, as a share of the control's way. */
const TOLERANCE = 0.012;

export function valueAt(keys: readonly Key[], time: number): number {
  const after = keys.findIndex((key) => key.time > time);
  if (after === 0) return keys[0]!.value;
  if (after < 0) return keys.at(-1)?.value ?? 0;
  const [from, to] = [keys[after - 1]!, keys[after]!];
  return from.value + ((to.value - from.value) * (time - from.time)) / (to.time - from.time);
}

/** What plays as an emotion at a time. */
export function cueAt(cues: readonly Cue[], time: number): Cue['plays'] {
  return cues.filter((cue) => cue.time <= time + 1e-6).at(-1)?.plays ?? null;
}

/** The values of all tracks at a time, by group and name. */
export function poseAt(take: Take, time: number): Record<string, Record<string, number>> {
  const pose: Record<string, Record<string, number>> = {};
  for (const { group, name, keys } of take.tracks) {
    (pose[group] ??= {})[name] = rounded(valueAt(keys, time));
  }
  return pose;
}

/** The take with a key more, or another value for the one that is there. */
export function withKey(take: Take, group: Group, name: string, key: Key): Take {
  const is = (track: Track): boolean => track.group === group && track.name === name;
  const track = take.tracks.find(is) ?? { group, name, keys: [] };
  const others = track.keys.filter(({ time }) => Math.abs(time - key.time) >= LEAST_STEP);
  const keys = [...others, { time: key.time, value: rounded(key.value) }].sort(byTime);
  const tracks = take.tracks.some(is)
    ? take.tracks.map((one) => (is(one) ? { ...track, keys } : one))
    : [...take.tracks, { ...track, keys }];
  return { ...take, tracks };
}

/** The take with keys at a time for all that controls hold, and for all that it moves already. */
export function withPose(take: Take, time: number, { controls, plays }: Held): Take {
  let keyed = take;
  for (const { group, name } of take.tracks) {
    if (!(name in controls[group])) keyed = withKey(keyed, group, name, { time, value: 0 });
  }
  for (const [group, values] of Object.entries(controls) as [Group, Record<string, number>][]) {
    for (const [name, value] of Object.entries(values)) {
      const known = keyed.tracks.some((track) => track.group === group && track.name === name);
      // What was not moved before this comes from rest at the beginning.
      if (!known && time > 0) keyed = withKey(keyed, group, name, { time: 0, value: 0 });
      keyed = withKey(keyed, group, name, { time, value });
    }
  }
  if (JSON.stringify(cueAt(take.cues, time)) === JSON.stringify(plays)) return keyed;
  const others = take.cues.filter((cue) => Math.abs(cue.time - time) >= LEAST_STEP);
  const cues = [...others, { time, plays }].sort((one, other) => one.time - other.time);
  return { ...keyed, cues };
}

/** The take without one key; a track goes with its last one. */
export function withoutKey(take: Take, group: Group, name: string, at: number): Take {
  const tracks = take.tracks
    .map((track) =>
      track.group === group && track.name === name
        ? { ...track, keys: track.keys.filter((_, index) => index !== at) }
        : track,
    )
    .filter(({ keys }) => keys.length > 0);
  return { ...take, tracks };
}

/** The part of a take between two times, beginning at 0. */
export function trimmed(take: Take, from: number, to: number): Take {
  const tracks = take.tracks.map((track) => ({
    ...track,
    keys: [
      { time: 0, value: rounded(valueAt(track.keys, from)) },
      ...track.keys
        .filter(({ time }) => time > from + LEAST_STEP && time < to - LEAST_STEP)
        .map(({ time, value }) => ({ time: time - from, value })),
      { time: to - from, value: rounded(valueAt(track.keys, to)) },
    ],
  }));
  const before = cueAt(take.cues, from);
  const cues = [
    ...(before === null ? [] : [{ time: 0, plays: before }]),
    ...take.cues
      .filter(({ time }) => time > from && time < to)
      .map((cue) => ({ ...cue, time: cue.time - from })),
  ];
  return { duration: to - from, tracks, cues };
}

/** A curve with as few keys as keep it where it was (Ramer, Douglas and Peucker). */
export function simplified(keys: readonly Key[]): Key[] {
  const way = Math.max(1, ...keys.map(({ value }) => Math.abs(value)));
  return keys.length < 3 ? [...keys] : reduced(keys, TOLERANCE * way);
}

function reduced(keys: readonly Key[], tolerance: number): Key[] {
  const ends = [keys[0]!, keys.at(-1)!];
  let worst = 0;
  let at = 0;
  for (let index = 1; index < keys.length - 1; index++) {
    const off = Math.abs(keys[index]!.value - valueAt(ends, keys[index]!.time));
    if (off > worst) [worst, at] = [off, index];
  }
  if (worst <= tolerance) return ends;
  return [
    ...reduced(keys.slice(0, at + 1), tolerance).slice(0, -1),
    ...reduced(keys.slice(at), tolerance),
  ];
}

function byTime(one: Key, other: Key): number {
  return one.time - other.time;
}

function rounded(value: number): number {
  return Math.round(1000 * value) / 1000;
}
