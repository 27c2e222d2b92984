// Recording what the controls do, and playing it.

import { beforeEach, describe, expect, it } from 'vitest';
import { Performer } from '../src/performer';
import { TimelineState } from '../src/state/timeline.svelte';
import type { Held } from '../src/take';
import { valueAt } from '../src/take';

describe('Performer', () => {
  let state: TimelineState;
  let performer: Performer;
  let held: Held;
  let waiting: ((now: number) => void)[];
  let now: number;
  let posed: { pose: unknown; fade: number }[];
  let cued: unknown[];
  const go = (frames: number): void => {
    for (let i = 0; i < frames; i++) {
      now += 1000 / 60;
      for (const run of waiting.splice(0)) run(now);
    }
  };

  beforeEach(() => {
    state = new TimelineState();
    held = {
      controls: { action_units: {}, muscles: {}, jaw: {}, gaze: {}, head: {}, tongue: {} },
      plays: null,
    };
    [waiting, now, posed, cued] = [[], 5000, [], []];
    performer = new Performer(state, {
      held: () => JSON.parse(JSON.stringify(held)) as Held,
      pose: (pose, fade) => posed.push({ pose, fade }),
      cue: (plays) => cued.push(plays),
      schedule: (run) => waiting.push(run),
    });
  });

  /** A second of rest, a smile that comes within a second, fear, and a second more. */
  const recordSmile = (): void => {
    performer.record();
    go(60);
    for (let i = 1; i <= 60; i++) {
      held.controls.action_units.AU12 = i / 60;
      go(1);
    }
    held.plays = { label: 'fear', intensity: 1 };
    go(60);
    performer.stop();
  };

  it('keeps what moved, in few keys', () => {
    recordSmile();
    const [track] = state.take.tracks;
    expect(state.take.duration).toBeCloseTo(3, 1);
    expect(track?.name).toBe('AU12');
    expect(track?.keys.length).toBeLessThan(6);
    for (const [time, value] of [
      [0.5, 0],
      [1.5, 0.5],
      [2.5, 1],
    ] as const) {
      expect(valueAt(track!.keys, time)).toBeCloseTo(value, 1);
    }
    expect(state.take.cues).toHaveLength(1);
    expect(state.take.cues[0]!.time).toBeCloseTo(2, 1);
  });

  it('plays it, says each cue once, and ends at its end', () => {
    recordSmile();
    performer.play();
    go(200);
    expect(state.playing).toBe(false);
    expect(state.time).toBe(state.to);
    expect(posed.length).toBeGreaterThan(60);
    expect(posed.length).toBeLessThan(120);
    expect(cued).toEqual([null, { label: 'fear', intensity: 1 }]);
  });

  it('goes round between the ends until it is stopped', () => {
    recordSmile();
    [state.from, state.to, state.loop] = [1, 1.5, true];
    performer.play();
    const seen: number[] = [];
    for (let i = 0; i < 120; i++) {
      go(1);
      seen.push(state.time);
    }
    expect(Math.min(...seen)).toBeGreaterThanOrEqual(1);
    expect(Math.max(...seen)).toBeLessThanOrEqual(1.5);
    expect(waiting).toHaveLength(1);
    performer.stop();
    go(2);
    expect(waiting).toHaveLength(0);
  });

  it('shows the face at a time', () => {
    recordSmile();
    performer.seek(1.5);
    expect(posed.at(-1)?.pose).toMatchObject({
      action_units: { AU12: expect.closeTo(0.5, 1) as number },
    });
  });
});
