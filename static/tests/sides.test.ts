// A unit is held as a whole or by its sides.

import { describe, expect, it } from 'vitest';
import { settledSides } from '../src/sides';

describe('sides of a unit', () => {
  it('give way to the whole', () => {
    expect(settledSides({ L12: 0.2, AU4: 1 }, 'AU12')).toEqual({ dropped: ['L12'], held: [] });
  });

  it('take over what the whole held', () => {
    expect(settledSides({ AU12: 0.6 }, 'L12')).toEqual({
      dropped: ['AU12'],
      held: [
        ['L12', 0.6],
        ['R12', 0.6],
      ],
    });
  });

  it('stand beside each other', () => {
    expect(settledSides({ L12: 0.2, AU1: 1 }, 'R12')).toEqual({ dropped: [], held: [] });
  });
});
