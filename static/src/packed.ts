// Reads every kind of frame in the order in which they come: packed ones say what changed. Mirrors service/packed.py.

import { inflate, InflateError } from './inflate';
import type { SurfaceFrame } from './surface-frame';
import { decodeFrame, decodeHead, HEAD_BYTES, ProtocolError } from './surface-frame';

const KIND_PACKED = 2;
const VERSION = 1;
const FLAG_THRUSTS = 2;
const BYTES_OF_THRUSTS = 8;
const PLANES = 6;

/** What has to be added to the address of a stream to be sent packed frames. */
export const PACKED_QUERY = 'frames=packed';

/** Whether a frame says all of a face, so that nothing before it is needed. */
export function standsAlone(buffer: ArrayBuffer): boolean {
  if (buffer.byteLength < HEAD_BYTES) return true;
  const view = new DataView(buffer);
  return view.getUint8(0) !== KIND_PACKED || view.getUint16(HEAD_BYTES - 2, true) === 0;
}

/** Keeps what the last packed frame said, since the next one may only say what is different. */
export class FrameReader {
  private tick = -1;
  /** Displacements from rest in grid steps, of every vertex: x of all, then y, then z. */
  private steps = new Int16Array(0);

  /**
   * Read the next frame; null if it cannot be told, because one before it was lost.
   * @throws ProtocolError when the bytes are not a frame of a known kind and version.
   */
  read(buffer: ArrayBuffer): SurfaceFrame | null {
    const isPacked = buffer.byteLength > 0 && new DataView(buffer).getUint8(0) === KIND_PACKED;
    return isPacked ? this.unpack(buffer) : decodeFrame(buffer);
  }

  private unpack(buffer: ArrayBuffer): SurfaceFrame | null {
    const { last: back, ...head } = decodeHead(buffer, KIND_PACKED, VERSION);
    const { tick, flags, vertexCount } = head;
    const thrusts = (flags & FLAG_THRUSTS) !== 0;
    const start = HEAD_BYTES + (thrusts ? BYTES_OF_THRUSTS : 0);
    if (buffer.byteLength < start) {
      throw new ProtocolError(`The frame has ${buffer.byteLength} bytes, its head needs ${start}.`);
    }
    if (back !== 0 && (tick !== (this.tick + back) % 2 ** 32 || !this.holds(vertexCount))) {
      return null;
    }
    this.take(unzip(new Uint8Array(buffer, start), vertexCount), vertexCount, back !== 0);
    this.tick = tick;
    const view = new DataView(buffer);
    return {
      ...head,
      headThrust: thrusts ? view.getFloat32(HEAD_BYTES, true) : 0,
      tongueThrust: thrusts ? view.getFloat32(HEAD_BYTES + 4, true) : 0,
      ...this.movedOnes(vertexCount),
    };
  }

  private holds(vertexCount: number): boolean {
    return this.tick >= 0 && this.steps.length === 3 * vertexCount;
  }

  /** Add up differences along each axis, over what is held if they are changes of it. */
  private take(planes: Uint8Array, vertexCount: number, changes: boolean): void {
    if (!changes) this.steps = new Int16Array(3 * vertexCount);
    const { steps } = this;
    const values = 3 * vertexCount;
    for (let axis = 0, at = 0; axis < 3; axis++) {
      let sum = 0;
      for (const end = at + vertexCount; at < end; at++) {
        const signless = planes[at]! | (planes[values + at]! << 8);
        sum += (signless >> 1) ^ -(signless & 1);
        steps[at]! += sum;
      }
    }
  }

  private movedOnes(vertexCount: number): Pick<SurfaceFrame, 'moved' | 'displacements'> {
    const { steps } = this;
    const moved = new Uint16Array(vertexCount);
    const displacements = new Int16Array(3 * vertexCount);
    let count = 0;
    for (let vertex = 0; vertex < vertexCount; vertex++) {
      const x = steps[vertex]!;
      const y = steps[vertexCount + vertex]!;
      const z = steps[2 * vertexCount + vertex]!;
      if ((x | y | z) === 0) continue;
      displacements[3 * count] = x;
      displacements[3 * count + 1] = y;
      displacements[3 * count + 2] = z;
      moved[count++] = vertex;
    }
    return {
      moved: moved.subarray(0, count),
      displacements: displacements.subarray(0, 3 * count),
    };
  }
}

function unzip(bytes: Uint8Array, vertexCount: number): Uint8Array {
  try {
    return inflate(bytes, PLANES * vertexCount);
  } catch (error) {
    if (error instanceof InflateError) {
      throw new ProtocolError(`A packed frame cannot be read: ${error.message}`);
    }
    throw error;
  }
}
