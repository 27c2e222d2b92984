// What goes over the wire when controls are moved, and in which order edits are sent.

import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { Commands } from '../src/commands';
import { Edits } from '../src/edits';
import { ViewerState } from '../src/state/viewer.svelte';

describe('Commands', () => {
  let viewer: ViewerState;
  let sent: Record<string, unknown>[];
  let frames: (() => void)[];
  let commands: Commands;
  const drawFrame = (): void => {
    for (const run of frames.splice(0)) run();
  };

  beforeEach(() => {
    viewer = new ViewerState();
    sent = [];
    frames = [];
    commands = new Commands(
      viewer,
      (text) => sent.push(JSON.parse(text) as Record<string, unknown>),
      (run) => frames.push(run),
    );
  });

  it('says once a frame what was moved', () => {
    commands.set('action_units', 'AU12', 0.1);
    commands.set('action_units', 'AU12', 0.4);
    commands.set('gaze', 'yaw', 10);
    expect(sent).toEqual([]);
    drawFrame();
    expect(sent).toEqual([{ type: 'controls', action_units: { AU12: 0.4 }, gaze: { yaw: 10 } }]);
  });

  it('tells that reports are old when a control moves, and when that is said at last', () => {
    const touched = vi.fn();
    const slow = new Commands(
      viewer,
      () => undefined,
      (run) => frames.push(run),
      touched,
    );
    slow.set('action_units', 'AU12', 0.1);
    expect(touched).toHaveBeenCalledTimes(1);
    drawFrame();
    expect(touched).toHaveBeenCalledTimes(2);
  });

  describe('that a report came before', () => {
    const late = (ms: number): void => {
      vi.advanceTimersByTime(ms);
    };

    beforeEach(() => {
      vi.useFakeTimers();
    });

    afterEach(() => {
      vi.useRealTimers();
    });

    it('are kept by a page that draws slowly', () => {
      commands.set('action_units', 'AU12', 0.9);
      drawFrame();
      commands.set('action_units', 'AU2', 0.2);
      late(1500);
      expect(commands.mayFollow({ action_units: { AU12: 0.9 } })).toBe(false);
    });

    it('are kept beside a service that answers slowly, which is believed in the end', () => {
      commands.set('action_units', 'AU12', 0.9);
      commands.set('action_units', 'AU2', 0.2);
      drawFrame();
      late(1500);
      expect(commands.mayFollow({ action_units: { AU12: 0.9 } })).toBe(false);
      expect(commands.mayFollow({ action_units: { AU12: 0.9, AU2: 0.5 } })).toBe(false);
      late(2000);
      expect(commands.mayFollow({ action_units: { AU12: 0.9 } })).toBe(true);
    });

    it('are left to it once it has heard of them', () => {
      commands.set('action_units', 'L12', 0.6);
      commands.set('action_units', 'R12', 0.6);
      commands.set('jaw', 'pitch', 5);
      drawFrame();
      late(800);
      const heard = { action_units: { AU12: 0.6 }, jaw: { pitch: 5 } };
      expect(commands.mayFollow(heard)).toBe(true);
      expect(commands.mayFollow({})).toBe(true);
    });

    it('are said before a performance goes on without them', () => {
      commands.set('action_units', 'AU6', 0.5);
      commands.perform({ action_units: { AU12: 0.3 } }, 0.1);
      drawFrame();
      expect(sent.map(({ action_units }) => action_units)).toEqual([{ AU6: 0.5 }, { AU12: 0.3 }]);
    });
  });

  it('leads through feelings, each with the dominance that goes with it', () => {
    const lain = { valence: 0.8, arousal: 0.5, dominance: 0.46, anchor: true };
    viewer.places = [{ name: 'happiness', ...lain }];
    commands.feel(0.2, 0.1);
    commands.feel(0.8, 0.5);
    drawFrame();
    const { valence, arousal, dominance } = lain;
    const said = { type: 'emotion', valence, arousal, dominance, fade_in: 0.15, seed: 0 };
    expect(sent).toEqual([said]);
    expect(viewer.feeling).toEqual({ valence, arousal });
  });

  it('undoes a gesture at once, emotions with it', () => {
    commands.set('action_units', 'AU12', 0.5);
    commands.set('action_units', 'AU12', 0.8);
    commands.playEmotion('fear', 1);
    drawFrame();
    commands.undo();
    expect(viewer.emotion).toBe('');
    expect(sent.slice(-2)).toMatchObject([
      { replace: true, layer: 'emotion' },
      { replace: true, layer: 'puppet', action_units: { AU12: 0.8 } },
    ]);
    commands.undo();
    expect(sent.at(-1)).toMatchObject({ replace: true, layer: 'puppet', action_units: {} });
    expect([viewer.canUndo, viewer.canRedo]).toEqual([false, true]);
    commands.redo();
    commands.redo();
    expect(viewer.emotion).toBe('fear');
  });

  it('plays units in place of whatever plays', () => {
    commands.playEmotion('fear', 1);
    commands.set('jaw', 'pitch', 5);
    commands.playUnits({ L12: 0.4 });
    expect(viewer.emotion).toBe('');
    expect(sent.at(-1)).toMatchObject({
      replace: true,
      action_units: { L12: 0.4 },
      jaw: { pitch: 5 },
    });
  });

  it('takes a unit apart without losing what it held', () => {
    commands.set('action_units', 'AU12', 0.5);
    drawFrame();
    commands.set('action_units', 'L12', 0.8);
    drawFrame();
    expect(sent.at(-1)).toEqual({
      type: 'controls',
      action_units: { AU12: 0, L12: 0.8, R12: 0.5 },
    });
    expect(viewer.sliders.action_units).toEqual({ L12: 0.8, R12: 0.5 });
  });

  it('joins the sides again', () => {
    commands.set('action_units', 'L12', 0.8);
    commands.set('action_units', 'AU12', 0.3);
    drawFrame();
    expect(sent.at(-1)).toEqual({ type: 'controls', action_units: { L12: 0, AU12: 0.3 } });
    expect(viewer.sliders.action_units).toEqual({ AU12: 0.3 });
  });

  it('lets go by saying what is still held', () => {
    commands.set('action_units', 'AU12', 0.5);
    commands.set('jaw', 'pitch', 5);
    drawFrame();
    commands.letGo('action_units', 'AU12');
    expect(sent.at(-1)).toMatchObject({
      replace: true,
      layer: 'puppet',
      action_units: {},
      jaw: { pitch: 5 },
    });
  });

  it('fades an emotion in, but follows its intensity at once', () => {
    commands.playEmotion('anger', 1);
    commands.playEmotion('anger', 0.5);
    expect(sent.map(({ fade_in }) => fade_in)).toEqual([null, 0]);
    commands.stopEmotion();
    expect(sent.at(-1)).toMatchObject({ layer: 'emotion', replace: true });
    expect(viewer.emotion).toBe('');
  });

  it('lets go of every layer on reset, and of what was about to be said', () => {
    commands.set('muscles', 'mentalis.L', 1);
    commands.reset();
    drawFrame();
    expect(sent.map(({ layer }) => layer)).toEqual(['idle', 'mood', 'emotion', 'speech', 'puppet']);
    expect(commands.mayFollow({})).toBe(false);
  });
});

describe('Edits', () => {
  it('sends one after the other, the newest of each key', async () => {
    vi.useFakeTimers();
    const log: string[] = [];
    const send = (name: string, ms: number) => async () => {
      log.push(`${name} starts`);
      await new Promise((resolve) => setTimeout(resolve, ms));
      log.push(`${name} ends`);
    };
    const edits = new Edits(vi.fn());
    edits.edit('damping', send('old damping', 50));
    edits.edit('damping', send('damping', 50));
    edits.edit('plate', send('plate', 10));
    await vi.advanceTimersByTimeAsync(1000);
    expect(log).toEqual(['damping starts', 'damping ends', 'plate starts', 'plate ends']);
    vi.useRealTimers();
  });

  it('tells what was refused, and goes on', async () => {
    vi.useFakeTimers();
    const failed = vi.fn();
    const next = vi.fn(() => Promise.resolve());
    const edits = new Edits(failed);
    edits.edit('damping', () => Promise.reject(new Error('too high')));
    edits.edit('plate', next);
    await vi.advanceTimersByTimeAsync(1000);
    expect(failed).toHaveBeenCalledExactlyOnceWith('damping', 'too high');
    expect(next).toHaveBeenCalledOnce();
    vi.useRealTimers();
  });
});
