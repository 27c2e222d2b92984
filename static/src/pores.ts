// The finest relief of skin, finer than the maps: pores and the furrows between them, as a tile that repeats.

import type { Texture } from 'three';
import { DataTexture, LinearFilter, LinearMipmapLinearFilter, RepeatWrapping } from 'three';

/** Side of the tile [texels], and how many cells of skin it holds along a side. */
const SIDE = 256;
const CELLS = 22;

/** Heights of a tile that repeats: plateaus between furrows, a pore at some corners; 0..1. */
export function poreHeights(side: number, cells: number): Float32Array {
  const heights = new Float32Array(side * side);
  for (let y = 0; y < side; y++) {
    for (let x = 0; x < side; x++) {
      heights[y * side + x] = height((x / side) * cells, (y / side) * cells, cells);
    }
  }
  return heights;
}

/** Tangent-space normals of the tile, as a texture with mipmaps; x and y of unit slope scale. */
export function createPores(): Texture {
  const heights = poreHeights(SIDE, CELLS);
  const texels = new Uint8Array(SIDE * SIDE * 4);
  const at = (x: number, y: number): number =>
    heights[((y + SIDE) % SIDE) * SIDE + ((x + SIDE) % SIDE)]!;
  for (let y = 0; y < SIDE; y++) {
    for (let x = 0; x < SIDE; x++) {
      const texel = (y * SIDE + x) * 4;
      texels[texel] = toByte(at(x - 1, y) - at(x + 1, y));
      texels[texel + 1] = toByte(at(x, y - 1) - at(x, y + 1));
      texels[texel + 2] = Math.round(255 * at(x, y));
      texels[texel + 3] = 255;
    }
  }
  const texture = new DataTexture(texels, SIDE, SIDE);
  texture.wrapS = texture.wrapT = RepeatWrapping;
  texture.minFilter = LinearMipmapLinearFilter;
  texture.magFilter = LinearFilter;
  texture.generateMipmaps = true;
  texture.anisotropy = 4;
  texture.needsUpdate = true;
  return texture;
}

/** A furrow runs where two cells' middles are equally far (Worley); every seventh cell has a pore in its middle. */
function height(x: number, y: number, cells: number): number {
  let nearest = Infinity;
  let second = Infinity;
  let pore = 0;
  for (let j = Math.floor(y) - 1; j <= Math.floor(y) + 1; j++) {
    for (let i = Math.floor(x) - 1; i <= Math.floor(x) + 1; i++) {
      const [dx, dy, lot] = middleOf(i, j, cells);
      const distance = Math.hypot(i + dx - x, j + dy - y);
      if (distance < nearest) {
        [second, nearest] = [nearest, distance];
        pore = lot;
      } else second = Math.min(second, distance);
    }
  }
  const furrow = Math.min(1, (second - nearest) / 0.34);
  const hole = pore < 0.14 ? Math.exp(-((nearest / 0.3) ** 2)) : 0;
  return 0.35 + 0.65 * Math.sqrt(furrow) - 0.35 * hole * Math.sqrt(furrow);
}

/** Middle of a cell within it, and a number that is its own; all 0..1. */
function middleOf(i: number, j: number, cells: number): [number, number, number] {
  const seed = ((i + cells) % cells) + ((j + cells) % cells) * cells;
  return [0.1 + 0.8 * lotOf(seed * 3), 0.1 + 0.8 * lotOf(seed * 3 + 1), lotOf(seed * 3 + 2)];
}

/** A hash of whole numbers (PCG's output function), 0..1. */
function lotOf(seed: number): number {
  let state = (Math.imul(seed, 747796405) + 2891336453) >>> 0;
  state = Math.imul((state >>> ((state >>> 28) + 4)) ^ state, 277803737) >>> 0;
  return ((state >>> 22) ^ state) / 2 ** 32 + (((state >>> 22) ^ state) < 0 ? 1 : 0);
}

function toByte(slope: number): number {
  return Math.round(127.5 + 127.5 * Math.min(1, Math.max(-1, slope)));
}
