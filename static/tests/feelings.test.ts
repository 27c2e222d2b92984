// The plane of feelings.

import { describe, expect, it } from 'vitest';
import { dominanceAt, middleOf, onPlane } from '../src/feelings';

const HAPPINESS = {
  name: 'happiness',
  valence: 0.8,
  arousal: 0.5,
  dominance: 0.46,
  anchor: true,
};
const NEUTRAL = { name: 'neutral', valence: 0, arousal: 0, dominance: 0, anchor: true };

describe('onPlane', () => {
  it('keeps points on it', () => {
    expect(onPlane(1.4, -0.333)).toEqual({ valence: 1, arousal: -0.33 });
  });
});

describe('dominanceAt', () => {
  it('is a place its own at the place, so that the place can be reached', () => {
    const places = [HAPPINESS, NEUTRAL, { ...HAPPINESS, dominance: -1, anchor: false }];
    expect(dominanceAt(HAPPINESS, places)).toBe(0.46);
    expect(dominanceAt({ valence: 0.4, arousal: 0.25 }, places)).toBe(0.23);
    expect(dominanceAt(NEUTRAL, [])).toBe(0);
  });
});

describe('middleOf', () => {
  it('lies between the recipes that are known', () => {
    const parts = ['happiness', 'neutral', 'unheard of'].map((recipe) => ({ recipe, weight: 0.3 }));
    expect(middleOf(parts, [HAPPINESS, NEUTRAL])).toEqual({ valence: 0.4, arousal: 0.25 });
    expect(middleOf([], [HAPPINESS])).toBeNull();
  });
});
