// What the timeline's buttons do.

import type { Clip } from './clip';
import { clipOf } from './clip';
import type { Performer } from './performer';
import { LONGEST_SECONDS } from './performer';
import type { Actions } from './state/actions';
import type { TimelineState } from './state/timeline.svelte';
import type { Held } from './take';
import { trimmed, withPose } from './take';

/** [s] */
const SHORTEST_SECONDS = 0.5;

export interface TakeParts {
  timeline: TimelineState;
  performer: Performer;
  held: () => Held;
  /** Of the rig that plays it. */
  rig: () => { id: string; name: string };
  /** Have the service render a clip. */
  render: (clip: Clip, onProgress: (share: number) => void) => Promise<Blob>;
  /** Give the visitor a file. */
  offer: (file: Blob, name: string) => void;
  failed: (error: unknown) => void;
}

type TakeActions = Pick<
  Actions,
  'recordTake' | 'playTake' | 'seekTake' | 'keyTake' | 'stretchTake' | 'trimTake' | 'exportTake'
>;

export function takeActions(parts: TakeParts): TakeActions {
  const { timeline, performer } = parts;
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
      const clip = clipOf(trimmed(timeline.take, timeline.from, timeline.to), id);
      if (form === 'json') {
        const text = JSON.stringify(clip, null, 1);
        parts.offer(new Blob([text], { type: 'application/json' }), `${name}.json`);
        return;
      }
      timeline.exporting = 0;
      parts
        .render(clip, (share) => (timeline.exporting = share))
        .then((file) => {
          parts.offer(file, `${name}.glb`);
        })
        .catch(parts.failed)
        .finally(() => (timeline.exporting = null));
    },
  };
}
