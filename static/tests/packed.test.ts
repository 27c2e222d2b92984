// Packed frames that are cut, changed or out of order; and deflate, undone as zlib does it.

import { readFileSync } from 'node:fs';
import { constants, deflateRawSync } from 'node:zlib';
import { describe, expect, it } from 'vitest';
import { inflate, InflateError } from '../src/inflate';
import { FrameReader, standsAlone } from '../src/packed';
import { ProtocolError } from '../src/surface-frame';

function golden(name: string): ArrayBuffer {
  const url = new URL(`../../tests/golden/frames/${name}.bin`, import.meta.url);
  return new Uint8Array(readFileSync(url)).buffer;
}

describe('FrameReader', () => {
  it('knows which frames need nothing before them', () => {
    expect(standsAlone(golden('wave'))).toBe(true);
    expect(standsAlone(golden('packed-whole'))).toBe(true);
    expect(standsAlone(golden('packed-change'))).toBe(false);
  });

  it('waits for a whole frame when it has not got what a change is told by', () => {
    const reader = new FrameReader();
    expect(reader.read(golden('packed-change'))).toBeNull();
    reader.read(golden('packed-rest'));
    expect(reader.read(golden('packed-change'))).toBeNull();
    expect(reader.read(golden('packed-whole'))?.tick).toBe(3600);
    expect(reader.read(golden('packed-change'))?.tick).toBe(3602);
    expect(reader.read(golden('packed-change'))).toBeNull();
  });

  it('refuses what is cut short, or says another number of vertices', () => {
    const whole = golden('packed-whole');
    const wrong = whole.slice(0);
    new DataView(wrong).setUint16(64, 3, true);
    for (const broken of [whole.slice(0, 40), whole.slice(0, -20), whole.slice(0, 68), wrong]) {
      expect(() => new FrameReader().read(broken)).toThrow(ProtocolError);
    }
    const thrusts = golden('packed-limits').slice(0, 70);
    new DataView(thrusts).setUint16(2, 2, true);
    expect(() => new FrameReader().read(thrusts)).toThrow(/its head needs 76/);
  });
});

/** Bytes with repeats, runs and noise, the same each time. */
function mixture(size: number): Uint8Array {
  let state = 1;
  return Uint8Array.from({ length: size }, (_, at) => {
    state = (state * 48271) % 2147483647;
    return at % 300 < 90 ? 0 : at % 300 < 200 ? at % 7 : state % 256;
  });
}

describe('inflate', () => {
  it.each([
    ['stored', { level: 0 }],
    ['quick', { level: 1 }],
    ['best', { level: 9 }],
    ['of fixed codes', { strategy: constants.Z_FIXED }],
    ['of literals only', { strategy: constants.Z_HUFFMAN_ONLY }],
    ['of runs', { strategy: constants.Z_RLE }],
  ])('undoes what zlib makes: %s', (_, options) => {
    for (const size of [0, 1, 5460, 70_000]) {
      const bytes = mixture(size);
      expect(Buffer.compare(inflate(deflateRawSync(bytes, options), size), bytes)).toBe(0);
    }
  });

  it('never runs on: bytes that are none of deflate, and another size, are refused', () => {
    const bytes = deflateRawSync(mixture(1000));
    expect(() => inflate(bytes, 999)).toThrow(InflateError);
    expect(() => inflate(bytes, 1001)).toThrow(InflateError);
    expect(() => inflate(bytes.subarray(0, 100), 1000)).toThrow(InflateError);
    for (let seed = 0; seed < 500; seed++) {
      const noise = bytes.map((byte, at) =>
        at % 97 === seed % 97 ? byte ^ (1 + (seed % 255)) : byte,
      );
      try {
        expect(inflate(noise, 1000).length).toBe(1000);
      } catch (error) {
        expect(error).toBeInstanceOf(InflateError);
      }
    }
  });
});
