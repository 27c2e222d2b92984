// Prints how long the viewer takes to decode frames, µs each, as JSON: `risorius bench --only stream` runs it in node.

import { readFileSync } from 'node:fs';
import { FrameReader } from '../src/packed';

const ROUNDS = 15;
/** Before it counts: the engine compiles what it runs often. */
const WARM_ROUNDS = 5;

/** A file of frames, each after its length (uint32, little endian). */
function framesIn(file: string): ArrayBuffer[] {
  const bytes = new Uint8Array(readFileSync(file));
  const view = new DataView(bytes.buffer);
  const frames: ArrayBuffer[] = [];
  for (let at = 0; at < bytes.length;) {
    const end = at + 4 + view.getUint32(at, true);
    frames.push(bytes.slice(at + 4, end).buffer);
    at = end;
  }
  return frames;
}

function microseconds(frames: ArrayBuffer[]): number {
  const taken: number[] = [];
  for (let round = 0; round < WARM_ROUNDS + ROUNDS; round++) {
    const reader = new FrameReader();
    const started = performance.now();
    for (const frame of frames) {
      if (reader.read(frame) === null) throw new Error('A frame was not told by the one before.');
    }
    if (round >= WARM_ROUNDS) taken.push(performance.now() - started);
  }
  return (1000 * Math.min(...taken)) / frames.length;
}

const taken = process.argv.slice(2).map((file) => microseconds(framesIn(file)));
process.stdout.write(JSON.stringify(taken));
