// What the timeline's buttons do.

import type { Clip } from './clip';
import { clipOf } from './clip';
import type { TrackReport, Waiting } from './clip-jobs';
import { Cancelled } from './clip-jobs';
import type { Performer } from './performer';
import { LONGEST_SECONDS } from './performer';
import type { Actions } from './state/actions';
import type { TimelineState } from './state/timeline.svelte';
import type { Held } from './take';
import { trimmed, withPose } from './take';
import { takeOf } from './take-of-clip';
import { kindOf, sentencesOf, takeOfTable } from './tracked';

/** [s] */
const SHORTEST_SECONDS = 0.5;

export interface TakeParts {
  timeline: TimelineState;
  performer: Performer;
  held: () => Held;
  /** Of the rig that plays it. */
  rig: () => { id: string; name: string };
  /** Have the service render a clip. */
  render: (clip: Clip, waiting: Waiting) => Promise<Blob>;
  /** Have the service read a tracker's file, as a table with a line a frame. */
  read: (
    file: Blob,
    rig: string,
    waiting: Waiting,
  ) => Promise<{ table: string; report: TrackReport | undefined }>;
  /** Give the visitor a file. */
  offer: (file: Blob, name: string) => void;
  failed: (error: unknown) => void;
  /** Say what went well. */
  tell: (sentence: string) => void;
}

type TakeActions = Pick<
  Actions,
  | 'recordTake'
  | 'playTake'
  | 'seekTake'
  | 'keyTake'
  | 'stretchTake'
  | 'trimTake'
  | 'exportTake'
  | 'openTake'
  | 'cancelTake'
>;

export function takeActions(parts: TakeParts): TakeActions {
  const { timeline, performer } = parts;
  let job = new AbortController();
  /** Show how far something is that the service does; what is cancelled fails in silence. */
  const waitFor = (work: (waiting: Waiting) => Promise<void>): void => {
    job = new AbortController();
    timeline.exporting = 0;
    work({ onProgress: (share) => (timeline.exporting = share), cancelled: job.signal })
      .catch((error: unknown) => {
        if (!(error instanceof Cancelled)) parts.failed(error);
      })
      .finally(() => (timeline.exporting = null));
  };
  return {
    recordTake() {
      if (timeline.recording) performer.stop();
      else performer.record();
    },
    playTake() {
      if (timeline.playing) performer.stop();
      else if (!timeline.empty && !timeline.recording) performer.play();
    },
    seekTake: (time) => {
      performer.seek(time);
    },
    keyTake() {
      if (timeline.recording) return;
      const take = withPose(timeline.take, timeline.time, parts.held());
      timeline.change(`key ${timeline.time}`, take);
    },
    stretchTake(duration) {
      if (!(duration >= SHORTEST_SECONDS && duration <= LONGEST_SECONDS)) return;
      const { take } = timeline;
      timeline.use(duration < take.duration ? trimmed(take, 0, duration) : { ...take, duration });
    },
    trimTake() {
      timeline.use(trimmed(timeline.take, timeline.from, timeline.to));
    },
    exportTake(form) {
      const { id, name } = parts.rig();
      const { options } = timeline;
      const played = trimmed(timeline.take, timeline.from, timeline.to);
      const clip = { ...clipOf(played, id, options.fps), ...(form === 'glb' ? options : {}) };
      if (form === 'json') {
        const text = JSON.stringify(clip, null, 1);
        parts.offer(new Blob([text], { type: 'application/json' }), `${name}.json`);
        return;
      }
      waitFor(async (waiting) => {
        parts.offer(await parts.render(clip, waiting), `${name}.glb`);
      });
    },
    openTake(file) {
      if (timeline.recording || timeline.exporting !== null) return;
      performer.stop();
      const type = kindOf(file.name);
      waitFor(async (waiting) => {
        if (type === null) {
          timeline.use(takeOf(await file.text()));
          parts.tell(`${file.name} is in the timeline.`);
          return;
        }
        const { id } = parts.rig();
        const { table, report } = await parts.read(new Blob([file], { type }), id, waiting);
        timeline.use(takeOfTable(table));
        if (report !== undefined) timeline.report = sentencesOf(file.name, report);
        performer.play();
      });
    },
    cancelTake() {
      job.abort();
    },
  };
}
