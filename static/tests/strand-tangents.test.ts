// Hair knows which way it runs, and how long it is: cards that are short have little sheen.

import { ShaderLib } from 'three';
import { describe, expect, it } from 'vitest';
import { makeHair } from '../src/hair-shader';
import { strandTangents } from '../src/strand-tangents';

/** A ribbon that runs up 3 and then forward 4, with its tip; and one that is 5 long. */
const BENT = [-1, 0, 0, 1, 0, 0, -1, 0, 3, 1, 0, 3, 0, 4, 3];
const STRAIGHT = [8, 0, 0, 10, 0, 0, 9, 0, 5];
const INDEX = [0, 1, 2, 2, 1, 3, 2, 3, 4, 5, 6, 7];

describe('strandTangents', () => {
  const tangents = strandTangents([...BENT, ...STRAIGHT], INDEX);
  const at = (vertex: number): number[] => [...tangents.slice(vertex * 4, vertex * 4 + 4)];

  it('run from root to tip, through the middle of what is on either side', () => {
    expect(at(0).slice(0, 3)).toEqual([0, 0, 1]);
    expect(at(4).slice(0, 3)).toEqual([0, 1, 0]);
    expect(at(2)[1]).toBeCloseTo(0.8);
    expect(at(3)[2]).toBeCloseTo(0.6);
    expect(at(7).slice(0, 3)).toEqual([0, 0, 1]);
  });

  it('tell the whole length of each strand at all of it', () => {
    for (const vertex of [0, 1, 2, 3, 4]) expect(at(vertex)[3]).toBeCloseTo(7);
    for (const vertex of [5, 6, 7]) expect(at(vertex)[3]).toBeCloseTo(5);
  });
});

describe('the sheen of hair', () => {
  it('grows with the length of cards, and is whole on single hairs', () => {
    const [cards, strands] = [true, false].map((cards) => {
      const { vertexShader, fragmentShader } = ShaderLib.physical;
      const program = { vertexShader, fragmentShader, uniforms: {} };
      makeHair(program, { cards, drawnHeight: { value: 0 }, fringe: { value: false } });
      return program;
    });
    expect(cards!.vertexShader).toMatch(
      /vSheen = mix\(0\.\d+, 1\.0, smoothstep\(.*strandTangent\.w/,
    );
    expect(cards!.fragmentShader).toContain('gloss * facing * vSheen');
    expect(strands!.fragmentShader).toContain('const float vSheen = 1.0');
  });
});
