// Gauges and the weights they spread, at numbers reckoned by hand.

import { describe, expect, it } from 'vitest';
import { Wrinkles } from '../src/wrinkles';

/** Two gauges of 10 mm from point 0; the first counts double. Vertices: first, half of each, none, too much of both. */
function gauges(): Wrinkles {
  return new Wrinkles({
    first: [0, 0],
    second: [1, 2],
    rest: [0.01, 0.01],
    gain: [2, 1],
    indptr: [0, 1, 3, 3, 5],
    indices: [0, 0, 1, 0, 1],
    weights: [1, 0.5, 0.5, 3, 3],
  });
}

function at(places: readonly (readonly number[])[]): Parameters<Wrinkles['update']>[0] {
  return (point, out) => {
    places[point]!.forEach((value, axis) => (out[axis] = value));
  };
}

const REST = [
  [0, 0, 0],
  [0.01, 0, 0],
  [0, 0.006, 0.008],
];

describe('Wrinkles', () => {
  it('are none at rest, and none where skin is stretched', () => {
    const wrinkles = gauges();
    expect(wrinkles.update(at(REST))).toBe(false);
    expect(wrinkles.update(at([[0, 0, 0], [0.02, 0, 0], REST[2]!]))).toBe(false);
    expect([...wrinkles.weights]).toEqual([0, 0, 0, 0]);
  });

  it('grow with the length lost, times the gain, and spread by the matrix', () => {
    const wrinkles = gauges();
    // 10 to 8 mm: 2 (1 - 0.8) = 0.4. 10 to 5 mm: 1 - 0.5 = 0.5.
    const pressed = at([
      [0, 0, 0],
      [0.008, 0, 0],
      [0, 0.003, 0.004],
    ]);
    expect(wrinkles.update(pressed)).toBe(true);
    [0.4, 0.45, 0, 1].forEach((weight, vertex) => {
      expect(wrinkles.weights[vertex]).toBeCloseTo(weight, 6);
    });
    expect(wrinkles.update(pressed)).toBe(false);
    expect(wrinkles.update(at(REST))).toBe(true);
    expect([...wrinkles.weights]).toEqual([0, 0, 0, 0]);
  });
});
