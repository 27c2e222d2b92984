// Frames of the stream: the bytes of a moment, decoded. docs/stream.md.

/** Where the fields of a surface frame lie, in bytes (little endian). */
const OFFSET = {
  kind: 0,
  version: 1,
  flags: 2,
  tick: 4,
  jawQuaternion: 8,
  jawOffset: 24,
  gaze: 36,
  head: 52,
  vertexCount: 64,
  movedCount: 66,
  bitmap: 68,
} as const;

const KIND_SURFACE = 1;
const VERSION = 1;
const FLAG_ASLEEP = 1;
const FLAG_THRUSTS = 2;
const BYTES_PER_DISPLACEMENT = 6;
const BYTES_OF_THRUSTS = 8;

/** One tick of the face. Displacements are absolute, from rest, so any frame stands alone. */
export interface SurfaceFrame {
  kind: number;
  version: number;
  flags: number;
  asleep: boolean;
  /** Session tick at 60 Hz. */
  tick: number;
  /** Rotation of the jaw, x y z w. */
  jawQuaternion: [number, number, number, number];
  /** Translation of the jaw's hinge from rest [m]. */
  jawOffset: [number, number, number];
  /** Left yaw, left pitch, right yaw, right pitch [degrees]. */
  gaze: [number, number, number, number];
  /** Yaw, pitch, roll [degrees]. */
  head: [number, number, number];
  /** How far the head is held forward [m]. */
  headThrust: number;
  /** How far the tongue is put out [m]. */
  tongueThrust: number;
  vertexCount: number;
  /** Indices of the vertices that are off their rest position, ascending. */
  moved: Uint16Array;
  /** Grid steps from rest of each moved vertex, x y z after x y z. */
  displacements: Int16Array;
}

export class ProtocolError extends Error {}

/** Bytes that every kind of frame begins with. */
export const HEAD_BYTES = OFFSET.bitmap;

/** What the first bytes of a frame say. */
export type FrameHead = Omit<
  SurfaceFrame,
  'headThrust' | 'tongueThrust' | 'moved' | 'displacements'
> & {
  /** What the two bytes at the end of it say, which each kind has for itself. */
  last: number;
};

/**
 * Read the bytes that every kind of frame begins with.
 * @throws ProtocolError when there are too few, or they are of another kind or version.
 */
export function decodeHead(buffer: ArrayBuffer, ofKind: number, ofVersion: number): FrameHead {
  if (buffer.byteLength < HEAD_BYTES) {
    throw new ProtocolError(
      `A frame has at least ${HEAD_BYTES} bytes, this one ${buffer.byteLength}.`,
    );
  }
  const view = new DataView(buffer);
  const kind = view.getUint8(OFFSET.kind);
  const version = view.getUint8(OFFSET.version);
  if (kind !== ofKind || version !== ofVersion) {
    throw new ProtocolError(
      `Frame of kind ${kind}, version ${version}; this viewer reads kind ${ofKind}, version ${ofVersion}. Reload the page.`,
    );
  }
  const float = (index: number): number => view.getFloat32(OFFSET.jawQuaternion + 4 * index, true);
  const flags = view.getUint16(OFFSET.flags, true);
  return {
    kind,
    version,
    flags,
    asleep: (flags & FLAG_ASLEEP) !== 0,
    tick: view.getUint32(OFFSET.tick, true),
    jawQuaternion: [float(0), float(1), float(2), float(3)],
    jawOffset: [float(4), float(5), float(6)],
    gaze: [float(7), float(8), float(9), float(10)],
    head: [float(11), float(12), float(13)],
    vertexCount: view.getUint16(OFFSET.vertexCount, true),
    last: view.getUint16(OFFSET.movedCount, true),
  };
}

/**
 * Read one binary frame.
 * @throws ProtocolError when the bytes are not a surface frame of a known version.
 */
export function decodeFrame(buffer: ArrayBuffer): SurfaceFrame {
  const { last: movedCount, ...head } = decodeHead(buffer, KIND_SURFACE, VERSION);
  const start = displacementsStart(head.vertexCount);
  const end = start + movedCount * BYTES_PER_DISPLACEMENT;
  const thrusts = (head.flags & FLAG_THRUSTS) !== 0;
  const least = end + (thrusts ? BYTES_OF_THRUSTS : 0);
  if (buffer.byteLength < least) {
    throw new ProtocolError(
      `${movedCount} moved vertices of ${head.vertexCount} need ${least} bytes, the frame has ${buffer.byteLength}.`,
    );
  }
  const view = new DataView(buffer);
  return {
    ...head,
    headThrust: thrusts ? view.getFloat32(end, true) : 0,
    tongueThrust: thrusts ? view.getFloat32(end + 4, true) : 0,
    moved: readBitmap(new Uint8Array(buffer, OFFSET.bitmap), head.vertexCount, movedCount),
    displacements: new Int16Array(buffer, start, movedCount * 3),
  };
}

/** The bitmap is padded to an even offset, so that the int16 values behind it are aligned. */
function displacementsStart(vertexCount: number): number {
  const end = OFFSET.bitmap + Math.ceil(vertexCount / 8);
  return end + (end & 1);
}

function readBitmap(bitmap: Uint8Array, vertexCount: number, movedCount: number): Uint16Array {
  const moved = new Uint16Array(movedCount);
  let found = 0;
  for (let byte = 0; byte * 8 < vertexCount; byte++) {
    let bits = bitmap[byte]!;
    for (let vertex = byte * 8; bits !== 0; vertex++, bits >>= 1) {
      if ((bits & 1) !== 0) moved[found++] = vertex;
    }
  }
  if (found !== movedCount) {
    throw new ProtocolError(`The bitmap marks ${found} vertices, the header says ${movedCount}.`);
  }
  return moved;
}
