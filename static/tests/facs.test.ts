// The FACS string of the panel.

import { describe, expect, it } from 'vitest';
import { facsOf, unitsOf } from '../src/state/facs';

describe('facsOf', () => {
  it('writes sliders to a hundredth and emotions in letters, by number and side', () => {
    const state = {
      layers: { puppet: { action_units: { AU4: 0.371, AU1: 0.6 } } },
      merged: {
        action_units: { AU26: 0.454, R12: 0.246, L12: 0.24, AU4: 0.371, AU1: 0.6, AU17: 0.01 },
      },
    };
    expect(facsOf(state)).toBe('1C+4:0.37+L12A+R12A+26B');
  });

  it('leaves idle life out', () => {
    const merged = {
      action_units: { AU45: 1, AU12: 0.8 },
      writers: { AU45: ['idle' as const], AU12: ['idle' as const, 'puppet' as const] },
    };
    expect(facsOf({ merged })).toBe('12D');
    expect(facsOf({})).toBe('');
  });
});

describe('unitsOf', () => {
  it('names sides and lips as commands do', () => {
    const read = [
      { name: 'AU12', side: 'L', intensity: 0.4 },
      { name: 'AU28', side: 'T', intensity: 0.2 },
      { name: 'AU1', side: '', intensity: 1 },
    ];
    expect(unitsOf(read)).toEqual({ L12: 0.4, T28: 0.2, AU1: 1 });
  });
});
