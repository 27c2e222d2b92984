// A tracker's file on the timeline: the table that the service made of it as curves, its report in sentences.

import type { TrackReport } from './clip-jobs';
import type { Group } from './state/actions';
import type { Key, Take, Track } from './take';
import { EMPTY, simplified } from './take';

/** Columns of angles, which other axes of the pose follow. */
const ANGLES: Record<string, readonly [Group, string]> = {
  head_yaw: ['head', 'yaw'],
  head_pitch: ['head', 'pitch'],
  head_roll: ['head', 'roll'],
  gaze_left_yaw: ['gaze', 'yaw'],
  gaze_left_pitch: ['gaze', 'pitch'],
};
/** Angles that never go further than this are none [degrees]. */
const LEAST_ANGLE = 0.5;
const LEAST_INTENSITY = 0.02;

/** What kind of tracker's file it is by its name, as the service wants to be told; null if it is none. */
export function kindOf(name: string): string | null {
  const ending = name.toLowerCase().split('.').at(-1);
  if (ending === 'csv' || ending === 'txt') return 'text/csv';
  return ending === 'jsonl' || ending === 'ndjson' ? 'application/jsonl' : null;
}

/**
 * The curves of a table with a line a frame.
 * @throws Error in a sentence where it has none.
 */
export function takeOfTable(table: string): Take {
  const [head = '', ...lines] = table.trim().split('\n');
  const names = head.split(',');
  const rows = lines.map((line) => line.split(',').map(Number));
  const times = rows.map((row) => row[names.indexOf('time')]!);
  const tracks: Track[] = [];
  names.forEach((column, at) => {
    const place = placeOf(column);
    if (place === null) return;
    const keys: Key[] = rows.map((row, index) => ({ time: times[index]!, value: row[at]! }));
    const least = place[0] === 'action_units' ? LEAST_INTENSITY : LEAST_ANGLE;
    if (keys.every(({ value }) => Math.abs(value) < least)) return;
    tracks.push({ group: place[0], name: place[1], keys: simplified(keys) });
  });
  if (tracks.length === 0) throw new Error('Nothing moves in this file: its face stays neutral.');
  return { ...EMPTY, duration: Math.max(0.5, times.at(-1) ?? 0), tracks };
}

function placeOf(column: string): readonly [Group, string] | null {
  if (/^(AU|[LR])\d+$/.test(column)) return ['action_units', column];
  return ANGLES[column] ?? null;
}

/** How well a file could be read, first what was read and then what to look at. */
export function sentencesOf(name: string, report: TrackReport): string[] {
  const { tracker, rows, used, duration, rate, left_out: leftOut = 0, notes } = report;
  const counted = used === rows ? `all ${rows} rows` : `${used} of ${rows} rows`;
  const first = `${name}, ${tracker}: ${counted} count, ${duration.toFixed(1)} s at ${Math.round(rate)} a second.`;
  const rest = leftOut > 0 ? [`${leftOut.toFixed(1)} s at its end are left out.`] : [];
  return [first, ...rest, ...notes];
}
