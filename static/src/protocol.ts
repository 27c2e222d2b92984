// The wire: decodes binary frames, reads the server's text messages, writes commands. Mirrors service/protocol.py.

export const SUBPROTOCOL = 'risorius.v1';

/** Layers of a face's timeline, from the one that yields first to the one that wins. */
export const LAYERS = ['idle', 'mood', 'emotion', 'speech', 'puppet'] as const;
export type Layer = (typeof LAYERS)[number];

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

export type Numbers = Record<string, number>;

/** What plays as an emotion: a label, or the mixture of scores or coordinates. */
export interface Played {
  /** Null for a mixture. */
  label: string | null;
  intensity: number;
  vocabulary?: string | null;
  found?: string;
  /** FACS at intensity 1. */
  recipe?: string;
  parts?: { recipe: string; weight: number; variant: number }[];
}

/** What somebody holds of a face. */
export interface Held {
  action_units?: Numbers;
  muscles?: Numbers;
  jaw?: Numbers;
  gaze?: Numbers;
  head?: Numbers;
  tongue?: Numbers;
  /** How much of what lies beneath is overridden, 0 to 1. */
  weight?: number;
  emotion?: Played;
}

/** What one owner holds in a layer. */
export interface Writer extends Held {
  owner: string;
  /** Tick since which it has held anything. */
  since: number;
  /** Seconds that are left of its lease; null if it stays. */
  expires_in: number | null;
}

/** What a layer comes to, and of whom: the one that came to the top last is at the end. */
export interface HeldLayer extends Held {
  writers?: Writer[];
}

/** What all layers come to together. */
export interface Merged extends Held {
  /** The action units as a FACS string. */
  facs?: string;
  /** How its letters are to be read. */
  scale?: 'linear' | 'banded';
  /** For each thing that is held the layers that hold it, lowest first. */
  writers?: Record<string, Layer[]>;
  /** The same with whose it is there. */
  owners?: Record<string, { layer: Layer; owner: string }[]>;
}

export interface FaceState {
  layers?: Partial<Record<Layer, HeldLayer>>;
  merged?: Merged;
  /** What the face does by itself; null for nothing. */
  idle?: Numbers | null;
}

/** The one expression that plays, by the name that a rig's emotion has too; empty for a mixture. */
export function expressionOf(played: Played | undefined): string {
  const [only, ...more] = played?.parts ?? [];
  return only !== undefined && more.length === 0 ? only.recipe : (played?.label ?? '');
}

export interface Hello {
  type: 'hello' | 'rig';
  protocol?: string;
  session: string;
  rig: string;
  surface: string;
  vertices: number;
  rate: number;
  /** Grid step of the displacements [m]. */
  grid: number;
  tick: number;
  state?: FaceState;
  /** `read` where nobody listens to commands. */
  role?: 'read' | 'control';
}

export interface StateMessage extends FaceState {
  type: 'state';
  state?: FaceState;
}

export interface ErrorMessage {
  type: 'error';
  error: string;
  message: string;
}

/** A command was obeyed, but not in every point. */
export interface WarningMessage {
  type: 'warning';
  message: string;
}

export interface OtherMessage {
  type: 'other';
}

export type ServerMessage = Hello | StateMessage | ErrorMessage | WarningMessage | OtherMessage;

/** Read a text frame; a type that this viewer does not know becomes `other`, and is left alone. */
export function readMessage(text: string): ServerMessage {
  const message = JSON.parse(text) as { type?: string };
  switch (message.type) {
    case 'hello':
    case 'rig':
    case 'state':
    case 'error':
    case 'warning':
      return message as ServerMessage;
    default:
      return { type: 'other' };
  }
}

/** What one command may move; a layer keeps everything that is not named. */
export interface Controls {
  layer?: Layer;
  fade?: number;
  /** Action units as a FACS string. */
  facs?: string;
  action_units?: Numbers;
  muscles?: Numbers;
  jaw?: Numbers;
  gaze?: Numbers;
  head?: Numbers;
  tongue?: Numbers;
}

/** Move what is named, as PATCH does. */
export function controlsCommand(controls: Controls): string {
  return JSON.stringify({ type: 'controls', ...controls });
}

/** Let a layer hold this and nothing else, as PUT does; without any values it lets go of everything. */
export function replaceCommand(controls: Controls): string {
  return JSON.stringify({ type: 'controls', replace: true, ...controls });
}

/** Play an emotion in its first variant: the same one while its intensity is dragged. */
export function emotionCommand(label: string, intensity: number, fadeIn: number | null): string {
  return JSON.stringify({ type: 'emotion', label, intensity, fade_in: fadeIn, seed: 0 });
}

/** Play the face of a point among feelings. @param fadeIn seconds until it is there. */
export function feelingCommand(
  point: { valence: number; arousal: number; dominance: number },
  fadeIn: number,
): string {
  return JSON.stringify({ type: 'emotion', ...point, fade_in: fadeIn, seed: 0 });
}

/** Have the face live by itself, or no more. */
export function idleCommand(on: boolean): string {
  return JSON.stringify({ type: 'idle', on });
}

export function ackCommand(tick: number): string {
  return JSON.stringify({ type: 'ack', tick });
}
