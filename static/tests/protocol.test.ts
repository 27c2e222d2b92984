// The frame decoder against the golden frames that the service writes, and the commands' shape.

import { readdirSync, readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { describe, expect, it } from 'vitest';
import { FrameReader } from '../src/packed';
import {
  controlsCommand,
  emotionCommand,
  expressionOf,
  readMessage,
  replaceCommand,
} from '../src/protocol';
import { decodeFrame, ProtocolError } from '../src/surface-frame';

const FRAMES = fileURLToPath(new URL('../../tests/golden/frames/', import.meta.url));
const GRID = 2e-5;

interface Golden {
  kind: number;
  /** Name of the frame that it says the changes of; only where it is told by one. */
  base?: string;
  version: number;
  flags: number;
  tick: number;
  jaw_quaternion: number[];
  jaw_offset: number[];
  gaze: number[];
  head: number[];
  /** Of head and tongue [m]; only where one is not 0. */
  thrusts?: number[];
  vertex_count: number;
  /** How many vertices moved. */
  moved: number;
  /** Of every vertex [m]. */
  displacements: number[][];
}

function bytes(name: string): ArrayBuffer {
  return new Uint8Array(readFileSync(FRAMES + name)).buffer;
}

const names = readdirSync(FRAMES)
  .filter((file) => file.endsWith('.bin'))
  .map((file) => file.replace('.bin', ''));

describe('frames', () => {
  it('are there to read, of both kinds', () => {
    const kinds = names.map((name) => new Uint8Array(bytes(`${name}.bin`))[0]);
    expect(new Set(kinds)).toEqual(new Set([1, 2]));
  });

  it.each(names)('are read as the service wrote them: %s', (name) => {
    const golden = JSON.parse(readFileSync(`${FRAMES}${name}.json`, 'utf8')) as Golden;
    const reader = new FrameReader();
    if (golden.base !== undefined) reader.read(bytes(`${golden.base}.bin`));
    const frame = reader.read(bytes(`${name}.bin`))!;
    expect(frame.kind).toBe(golden.kind);
    expect(frame.version).toBe(golden.version);
    expect(frame.flags).toBe(golden.flags);
    expect(frame.asleep).toBe((golden.flags & 1) === 1);
    expect(frame.tick).toBe(golden.tick);
    expect(frame.vertexCount).toBe(golden.vertex_count);
    expect(frame.moved.length).toBe(golden.moved);
    for (const [got, wanted] of [
      [frame.jawQuaternion, golden.jaw_quaternion],
      [frame.jawOffset, golden.jaw_offset],
      [frame.gaze, golden.gaze],
      [frame.head, golden.head],
      [[frame.headThrust, frame.tongueThrust], golden.thrusts ?? [0, 0]],
    ] as const) {
      got.forEach((value, index) => {
        expect(value).toBeCloseTo(wanted[index]!, 5);
      });
    }
    const displacements = golden.displacements.map(() => [0, 0, 0]);
    frame.moved.forEach((vertex, index) => {
      displacements[vertex] = [...frame.displacements.subarray(index * 3, index * 3 + 3)].map(
        (step) => step * GRID,
      );
    });
    const wanted = golden.displacements.flat();
    const worst = displacements
      .flat()
      .reduce((most, value, i) => Math.max(most, Math.abs(value - wanted[i]!)), 0);
    expect(worst).toBeLessThan(1e-9);
  });

  it('are refused in another version, and cut short', () => {
    const other = bytes('wave.bin');
    new DataView(other).setUint8(1, 9);
    expect(() => decodeFrame(other)).toThrow(ProtocolError);
    expect(() => decodeFrame(bytes('wave.bin').slice(0, -2))).toThrow(/need/);
    expect(() => decodeFrame(new ArrayBuffer(10))).toThrow(/at least 68/);
  });

  it('are refused with a bitmap that does not fit the header', () => {
    const broken = bytes('wave.bin');
    new Uint8Array(broken)[68]! ^= 1;
    expect(() => decodeFrame(broken)).toThrow(/bitmap/);
  });
});

describe('text messages', () => {
  it('writes commands as the service reads them', () => {
    expect(JSON.parse(controlsCommand({ action_units: { AU12: 0.5 } }))).toEqual({
      type: 'controls',
      action_units: { AU12: 0.5 },
    });
    expect(JSON.parse(replaceCommand({ layer: 'emotion', fade: 0.2 }))).toEqual({
      type: 'controls',
      replace: true,
      layer: 'emotion',
      fade: 0.2,
    });
    expect(JSON.parse(emotionCommand('happiness', 0.8, 0.25))).toEqual({
      type: 'emotion',
      label: 'happiness',
      intensity: 0.8,
      fade_in: 0.25,
      seed: 0,
    });
  });

  it('names the one expression that plays, in whatever words it was asked for', () => {
    const joy = { label: 'joy', intensity: 1 };
    const happiness = { recipe: 'happiness', weight: 1, variant: 2 };
    const surprise = { recipe: 'surprise', weight: 0.4, variant: 0 };
    expect(expressionOf({ ...joy, parts: [happiness] })).toBe('happiness');
    expect(expressionOf(joy)).toBe('joy');
    expect(expressionOf({ ...joy, label: null, parts: [happiness, surprise] })).toBe('');
    expect(expressionOf(undefined)).toBe('');
  });

  it('leaves alone what it does not know', () => {
    expect(readMessage('{"type": "weather"}')).toEqual({ type: 'other' });
  });
});
