// One command per animation frame, one edit per pause, and the tick rate that is shown.

import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { TickRate } from '../src/tick-rate';
import { debounce, Throttle } from '../src/throttle';

describe('Throttle', () => {
  it('sends the newest values of one frame as one command', () => {
    const flush = vi.fn();
    const frames: (() => void)[] = [];
    const throttle = new Throttle(flush, (run) => frames.push(run));
    throttle.set('action_units', 'AU12', 0.1);
    throttle.set('action_units', 'AU12', 0.2);
    throttle.set('jaw', 'pitch', 5);
    expect(frames.length).toBe(1);
    frames.shift()!();
    expect(flush).toHaveBeenCalledExactlyOnceWith({
      action_units: { AU12: 0.2 },
      jaw: { pitch: 5 },
    });
    throttle.set('jaw', 'pitch', 6);
    frames.shift()!();
    expect(flush).toHaveBeenLastCalledWith({ jaw: { pitch: 6 } });
  });

  it('sends nothing after it was cleared', () => {
    const flush = vi.fn();
    const frames: (() => void)[] = [];
    const throttle = new Throttle(flush, (run) => frames.push(run));
    throttle.set('jaw', 'pitch', 5);
    throttle.clear();
    frames.shift()!();
    expect(flush).not.toHaveBeenCalled();
  });
});

describe('debounce', () => {
  beforeEach(() => vi.useFakeTimers());
  afterEach(() => vi.useRealTimers());

  it('acts once, on the last call, after the pause', () => {
    const action = vi.fn();
    const edit = debounce(action, 100);
    edit(1);
    vi.advanceTimersByTime(60);
    edit(2);
    vi.advanceTimersByTime(99);
    expect(action).not.toHaveBeenCalled();
    vi.advanceTimersByTime(1);
    expect(action).toHaveBeenCalledExactlyOnceWith(2);
  });
});

describe('TickRate', () => {
  it('counts ticks, not frames', () => {
    const rate = new TickRate();
    let shown = 0;
    for (let i = 0; i <= 30; i++) shown = rate.at(i * 2, i * 33.33);
    expect(shown).toBe(60);
  });

  it('starts anew after a pause', () => {
    const rate = new TickRate();
    rate.at(1, 0);
    rate.at(2, 5000);
    expect(rate.at(62, 6000)).toBe(60);
  });
});
