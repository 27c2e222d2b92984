// Which devices are given less than all there is.

import { describe, expect, it } from 'vitest';
import type { Device } from '../src/level';
import { atLevel, levelFor } from '../src/level';

const DESK: Device = { memory: null, screen: 1080, touch: false, graphics: 'ANGLE (Intel, Iris)' };

describe('levelFor', () => {
  it('gives a desk all there is, also if its browser does not tell its memory', () => {
    expect(levelFor(DESK)).toBe('high');
    expect(levelFor({ ...DESK, memory: 8 })).toBe('high');
  });

  it.each<Partial<Device>>([
    { memory: 4 },
    { screen: 412 },
    { touch: true },
    { graphics: 'ANGLE (Google, Vulkan 1.3 (SwiftShader Device))' },
  ])('gives less to %o', (device) => {
    expect(levelFor({ ...DESK, ...device })).toBe('medium');
  });
});

describe('atLevel', () => {
  it('leaves the address of the high level as it is', () => {
    const address = 'http://host/api/rigs/standard/surface.glb';
    expect(atLevel(address, 'high')).toBe(address);
    expect(atLevel(address, 'medium')).toBe(`${address}?level=medium`);
  });
});
