// Views by name, by degrees, and at landmarks.

import { describe, expect, it } from 'vitest';
import { readPageOptions } from '../src/url';
import { isView, shotOf } from '../src/views';

const NOWHERE = (): null => null;

describe('shotOf', () => {
  it('turns by so many degrees to the face s left', () => {
    expect(shotOf('profile', NOWHERE).angle).toBe(90);
    expect(shotOf('left', NOWHERE).angle).toBe(-90);
    expect(shotOf('-50', NOWHERE).angle).toBe(-50);
    expect(shotOf('25', NOWHERE).target).toEqual(shotOf('front', NOWHERE).target);
  });

  it('looks between the landmarks in a close-up', () => {
    const places: Record<string, [number, number, number]> = {
      'en.L': [0.016, 0, 0.078],
      'ex.L': [0.046, 0.002, 0.074],
    };
    const shot = shotOf('eye', (name) => places[name] ?? null);
    [0.031, 0.004, 0.076].forEach((value, axis) => {
      expect(shot.target[axis]).toBeCloseTo(value, 9);
    });
    expect(shot.halfHeight).toBeLessThan(0.05);
  });

  it('shows the head where a face has no such landmarks', () => {
    const head = shotOf('front', NOWHERE);
    expect(shotOf('mouth', NOWHERE).halfHeight).toBe(head.halfHeight);
  });

  it.each(['', ' ', 'behind', '181', 'NaN'])('knows no view "%s"', (view) => {
    expect(isView(view)).toBe(false);
    expect(() => shotOf(view, NOWHERE)).toThrow('known are front');
  });
});

describe('the page s address', () => {
  it('may name a view or degrees, and a level', () => {
    expect(readPageOptions('?view=ear&level=medium')).toMatchObject({
      view: 'ear',
      level: 'medium',
    });
    expect(readPageOptions('?view=-25').view).toBe('-25');
    expect(readPageOptions('?view=behind&level=best')).toMatchObject({
      view: 'front',
      level: null,
    });
  });
});
