// Keyframes of a clip as curves, the other way of clip.ts.

import type { Clip, Keyframe } from './clip';
import type { Group } from './state/actions';
import type { Cue, Take } from './take';
import { EMPTY, valueAt, withKey } from './take';

const GROUPS: readonly Group[] = ['action_units', 'muscles', 'jaw', 'gaze', 'head', 'tongue'];
const KNOWN = new Set(['time', 'fade', 'fade_in', 'layer', 'replace', 'emotion', ...GROUPS]);

/** @throws Error in a sentence, where a file is no timeline, or has what curves cannot show. */
export function takeOf(text: string): Take {
  const clip = read(text);
  let take: Take = { ...EMPTY, duration: lengthOf(clip) };
  const cues: Cue[] = [];
  for (const keyframe of [...clip.timeline].sort((one, other) => one.time - other.time)) {
    const strange = Object.keys(keyframe).find((field) => !KNOWN.has(field));
    if (strange !== undefined)
      throw new Error(
        `The timeline has "${strange}", which has no curve; risorius clip renders it.`,
      );
    if (keyframe.emotion !== undefined || keyframe.layer === 'emotion') cues.push(cueOf(keyframe));
    else take = withFades(take, keyframe);
  }
  return { ...take, cues };
}

function read(text: string): Pick<Clip, 'timeline'> & Partial<Clip> {
  let found: unknown;
  try {
    found = JSON.parse(text);
  } catch {
    throw new Error('The file is no JSON.');
  }
  const timeline = (found as Partial<Clip> | null)?.timeline;
  if (!Array.isArray(timeline) || !timeline.every(({ time }) => typeof time === 'number'))
    throw new Error('The file has no "timeline" of keyframes that have a "time".');
  return found as Clip;
}

function lengthOf({ duration, timeline }: ReturnType<typeof read>): number {
  return duration ?? Math.max(1, ...timeline.map(({ time, fade = 0 }) => time + fade + 0.5));
}

/** From where each value is, in a straight line to where the keyframe wants it. */
function withFades(take: Take, keyframe: Keyframe): Take {
  const { time } = keyframe;
  const fade = keyframe.fade ?? (typeof keyframe.fade_in === 'number' ? keyframe.fade_in : 0);
  let changed = take;
  for (const group of GROUPS) {
    const values = Object.entries((keyframe[group] ?? {}) as Record<string, unknown>);
    for (const [name, value] of values) {
      if (typeof value !== 'number')
        throw new Error(`The timeline gives ${name} as "${String(value)}"; curves need numbers.`);
      const known = changed.tracks.find((track) => track.group === group && track.name === name);
      const before = known === undefined ? 0 : valueAt(known.keys, time);
      if (time > 0 || fade > 0) changed = withKey(changed, group, name, { time, value: before });
      changed = withKey(changed, group, name, {
        time: time + Math.max(fade, time > 0 ? 0.02 : 0),
        value,
      });
    }
  }
  return changed;
}

function cueOf({ time, emotion }: Keyframe): Cue {
  if (emotion === undefined || emotion === null) return { time, plays: null };
  if (typeof emotion === 'string') return { time, plays: { label: emotion, intensity: 1 } };
  const said = emotion as Record<string, unknown>;
  const number = (field: string, otherwise: number): number =>
    typeof said[field] === 'number' ? said[field] : otherwise;
  if (typeof said.label === 'string')
    return { time, plays: { label: said.label, intensity: number('intensity', 1) } };
  if (typeof said.valence !== 'number')
    throw new Error('The timeline has an emotion of scores, which has no place here.');
  const [valence, arousal] = [said.valence, number('arousal', 0)];
  return { time, plays: { valence, arousal, dominance: number('dominance', 0) } };
}
