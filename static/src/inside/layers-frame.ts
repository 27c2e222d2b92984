// The bytes of the tissue under the skin: docs/stream.md. Mirrors service/layers.py.

const KIND = 16;
const VERSION = 1;
const HEADER = 8;
const GRID = 2e-5;
/** Dermis, hypodermis, bone. */
const SHEETS = 3;

export interface LayersFrame {
  tick: number;
  /** Of a sheet. */
  nodes: number;
  /** From rest [m], x y z of each node of dermis, hypodermis and bone, sheet by sheet. */
  displacements: Float32Array;
}

/** @throws Error when the bytes are of another kind or version, or too few. */
export function decodeLayers(buffer: ArrayBuffer): LayersFrame {
  const view = new DataView(buffer);
  const known =
    buffer.byteLength >= HEADER && view.getUint8(0) === KIND && view.getUint8(1) === VERSION;
  const nodes = known ? view.getUint16(2, true) : 0;
  if (!known || buffer.byteLength !== HEADER + 6 * SHEETS * nodes) {
    throw new Error('The service tells of the tissue in another form. Reload the page.');
  }
  const displacements = new Float32Array(3 * SHEETS * nodes);
  for (let at = 0; at < displacements.length; at++) {
    displacements[at] = view.getInt16(HEADER + 2 * at, true) * GRID;
  }
  return { tick: view.getUint32(4, true), nodes, displacements };
}
