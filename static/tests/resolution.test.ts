// A slow device draws fewer pixels while things move.

import { describe, expect, it } from 'vitest';
import { Resolution } from '../src/resolution';

/** Draw a while on a device that takes `cost` for a ratio of 1, never quicker than its screen. */
function draw(resolution: Resolution, times: number, cost: number): void {
  for (let i = 0; i < times; i++) resolution.took(Math.max(16.7, cost * resolution.ratio ** 2));
}

describe('Resolution', () => {
  it('stays full where that is quick', () => {
    const resolution = new Resolution(2, 0.5);
    draw(resolution, 500, 4);
    expect([resolution.ratio, resolution.sharp]).toEqual([2, 2]);
  });

  it('goes down until it is quick enough, and is sharp at rest if that can be afforded', () => {
    const resolution = new Resolution(1.5, 0.5);
    draw(resolution, 200, 60);
    expect(resolution.ratio).toBeLessThan(0.82);
    expect(resolution.ratio).toBeGreaterThan(0.6);
    expect(resolution.sharp).toBe(1.5);
  });

  it('keeps to the least, and makes no picture that takes seconds', () => {
    const resolution = new Resolution(2, 0.5);
    draw(resolution, 300, 1000);
    expect(resolution.ratio).toBe(0.5);
    expect(resolution.sharp).toBeLessThan(1);
  });

  it('comes up again when the device has room', () => {
    const resolution = new Resolution(1.5, 0.5);
    draw(resolution, 100, 200);
    const low = resolution.ratio;
    draw(resolution, 2000, 3);
    expect(low).toBeLessThan(0.6);
    expect(resolution.ratio).toBe(1.5);
  });

  it('takes one slow picture for chance', () => {
    const resolution = new Resolution(2, 0.5);
    draw(resolution, 20, 4);
    resolution.took(900);
    draw(resolution, 20, 4);
    expect(resolution.ratio).toBe(2);
  });
});
