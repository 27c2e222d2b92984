// Takes: curves, and what the service is told of them.

import { describe, expect, it } from 'vitest';
import { clipOf } from '../src/clip';
import type { Take } from '../src/take';
import { takeOf } from '../src/take-of-clip';
import { poseAt, simplified, trimmed, valueAt, withKey, withoutKey, withPose } from '../src/take';

const key = (time: number, value: number) => ({ time, value });
const NOTHING = { action_units: {}, muscles: {}, jaw: {}, gaze: {}, head: {}, tongue: {} };
const TAKE: Take = {
  duration: 2,
  tracks: [
    { group: 'action_units', name: 'AU12', keys: [key(0, 0.2), key(1, 0.8), key(2, 0)] },
    { group: 'jaw', name: 'pitch', keys: [key(0, 0), key(1, 10)] },
  ],
  cues: [
    { time: 0.5, plays: { label: 'fear', intensity: 1 } },
    { time: 1.5, plays: null },
  ],
};

describe('a curve', () => {
  it('runs straight between keys and stays beyond them', () => {
    const keys = [key(1, 0), key(2, 1)];
    expect([0, 1, 1.25, 2, 9].map((time) => valueAt(keys, time))).toEqual([0, 0, 0.25, 1, 1]);
    expect(valueAt([], 1)).toBe(0);
  });

  it('is simplified without going elsewhere', () => {
    const wave = Array.from({ length: 200 }, (_, i) => key(i / 60, 0.5 + 0.5 * Math.sin(i / 20)));
    const few = simplified(wave);
    expect(few.length).toBeLessThan(40);
    for (const { time, value } of wave) {
      expect(Math.abs(valueAt(few, time) - value)).toBeLessThan(0.0121);
    }
  });
});

describe('a take', () => {
  it('poses the face at a time', () => {
    expect(poseAt(TAKE, 0.5)).toEqual({ action_units: { AU12: 0.5 }, jaw: { pitch: 5 } });
  });

  it('gains keys, changes and loses them', () => {
    const more = withKey(TAKE, 'action_units', 'AU4', key(1, 0.5));
    expect(more.tracks).toHaveLength(3);
    const changed = withKey(more, 'action_units', 'AU4', key(1.001, 0.7));
    expect(changed.tracks[2]!.keys).toEqual([key(1.001, 0.7)]);
    expect(withoutKey(changed, 'action_units', 'AU4', 0).tracks).toHaveLength(2);
  });

  it('takes a pose in, and lets go of what it moved before', () => {
    const posed = withPose({ duration: 4, tracks: [], cues: [] }, 1, {
      controls: { ...NOTHING, action_units: { AU1: 1 } },
      plays: { label: 'joy', intensity: 1 },
    });
    expect(posed.tracks[0]!.keys).toEqual([key(0, 0), key(1, 1)]);
    expect(posed.cues).toEqual([{ time: 1, plays: { label: 'joy', intensity: 1 } }]);
    const rest = withPose(posed, 2, { controls: NOTHING, plays: null });
    expect(rest.tracks[0]!.keys.at(-1)).toEqual(key(2, 0));
    expect(rest.cues.at(-1)).toEqual({ time: 2, plays: null });
  });

  it('is trimmed to what lay between two times', () => {
    const part = trimmed(TAKE, 0.5, 1.5);
    expect(part.duration).toBe(1);
    expect(part.tracks[0]!.keys).toEqual([key(0, 0.5), key(0.5, 0.8), key(1, 0.4)]);
    expect(part.cues).toEqual([{ time: 0, plays: { label: 'fear', intensity: 1 } }]);
  });
});

describe('clipOf', () => {
  it('says straight pieces as keyframes that fade to their end', () => {
    expect(clipOf(TAKE, 'standard')).toEqual({
      rig: 'standard',
      fps: 30,
      duration: 2,
      timeline: [
        { time: 0, fade: 0, action_units: { AU12: 0.2 } },
        { time: 0, fade: 1, action_units: { AU12: 0.8 }, jaw: { pitch: 10 } },
        { time: 0.5, emotion: { label: 'fear', intensity: 1, seed: 0 } },
        { time: 1, fade: 1, action_units: { AU12: 0 } },
        { time: 1.5, layer: 'emotion', replace: true, fade: 0.2 },
      ],
    });
  });
});

describe('takeOf', () => {
  it('reads what clipOf writes', () => {
    const again = takeOf(JSON.stringify(clipOf(TAKE, 'standard')));
    expect(again.duration).toBe(2);
    expect(again.cues).toEqual(TAKE.cues);
    for (const time of [0.1, 0.5, 1, 1.6, 2]) {
      const [was, is] = [poseAt(TAKE, time), poseAt(again, time)];
      expect(is.action_units!.AU12).toBeCloseTo(was.action_units!.AU12!, 1);
      expect(is.jaw!.pitch).toBeCloseTo(was.jaw!.pitch!, 1);
    }
  });

  it('says what it cannot read', () => {
    expect(() => takeOf('AU12_r, AU15_r')).toThrow('no JSON');
    expect(() => takeOf('{"timeline": 3}')).toThrow('no "timeline"');
    expect(() => takeOf('{"timeline": [{"time": 0, "facs": "12C"}]}')).toThrow('"facs"');
    expect(() => takeOf('{"timeline": [{"time": 0, "action_units": {"AU4": "B"}}]}')).toThrow(
      'curves need numbers',
    );
  });
});
