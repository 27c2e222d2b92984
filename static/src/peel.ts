// What of a face is left out where it is peeled: skin, in its shader, and whole strands of hair.

import type { BufferAttribute, BufferGeometry } from 'three';
import { Float32BufferAttribute, Uint32BufferAttribute } from 'three';
import { plainArray } from './gltf-nodes';
import type { Outline } from './inside/outline';
import { insideOf } from './inside/outline';
import { strandRuns } from './strand-sides';

/** A cut that leaves everything [m]. */
export const NOTHING_PEELED = 1e3;

/** Skin goes a little over the sheets' border, which it does not follow as closely as that, so that no slit gapes [m]. */
const OVER = 1.5e-3;

/** Skin inside the sheets of tissue and further to the face's left than `peelCut` [m] is left out. */
export const PEEL_VERTEX = /* glsl */ `
attribute vec2 peeling;
varying vec2 vPeeling;`;
export const PEEL_FRAGMENT = /* glsl */ `
uniform float peelCut;
varying vec2 vPeeling;
/** How much of a pixel is left: the cut's edge runs through it. */
float leftOfPeel() {
  float gone = min(vPeeling.x - ${OVER.toFixed(4)}, vPeeling.y - peelCut);
  return clamp(0.5 - gone / max(fwidth(gone), 1e-9), 0.0, 1.0);
}`;

/** What of a face can be peeled; places in metres, in the head's frame at rest. */
export interface Peelable {
  skin: BufferGeometry;
  positions: ArrayLike<number>;
  /** First of the vertices that lie at the same place, for each. */
  seams: ArrayLike<number> | null;
  /** Hair of every kind, and the vertices of the skin that it rides on; null where it stays as it is. */
  hair: { geometry: BufferGeometry; roots: ArrayLike<number> | null }[];
}

/** A strand: its place in the index, and whether and how far to the left it grows out of what is peeled. */
interface Strand {
  from: number;
  to: number;
  within: boolean;
  across: number;
}

/** For hair on its skin one vertex in so many says where that is. */
const EVERY = 4;

export class Peel {
  private readonly hair: { geometry: BufferGeometry; own: BufferAttribute; strands: Strand[] }[];
  private cut = NOTHING_PEELED;

  /** @param outline of the tissue's sheets [m, head frame]. */
  constructor({ skin, positions, seams, hair }: Peelable, outline: Outline) {
    const triangles = skin.getIndex()!.array;
    const inside = insideOf(outline, { positions, triangles }, seams);
    const peeling = new Float32Array(2 * inside.length);
    inside.forEach((depth, at) => {
      peeling[2 * at] = depth;
      peeling[2 * at + 1] = positions[3 * at]!;
    });
    skin.setAttribute('peeling', new Float32BufferAttribute(peeling, 2));
    this.hair = hair.map(({ geometry, roots }) => {
      const own = geometry.getIndex()!;
      const places = plainArray(geometry.getAttribute('position'));
      const rootOf = (vertex: number): number =>
        roots?.[vertex] ?? nearest(positions, places, vertex);
      let at = 0;
      const strands = strandRuns(own.array).map(([first, last]): Strand => {
        const from = at;
        while (at < own.count && own.array[at]! <= last) at++;
        // Of a strand that falls over the face from beyond it, what lies over the face counts.
        const under = [first, (first + last) >> 1, last].map(rootOf);
        const within = under.filter((vertex) => inside[vertex]! > 0).length >= 2;
        return { from, to: at, within, across: positions[3 * under[1]!]! };
      });
      return { geometry, own, strands };
    });
  }

  /** Leave out the strands that grow on what is peeled, further to the left than this [m]. */
  cutAt(cut: number): void {
    if (cut === this.cut) return;
    this.cut = cut;
    for (const { geometry, own, strands } of this.hair) {
      const left = strands.filter(({ within, across }) => !within || across < cut);
      if (left.length === strands.length) {
        geometry.setIndex(own);
        continue;
      }
      const index = left.flatMap(({ from, to }) => [...own.array.subarray(from, to)]);
      geometry.setIndex(new Uint32BufferAttribute(index, 1));
    }
  }
}

/** A vertex of the skin near one of a strand. */
function nearest(skin: ArrayLike<number>, places: ArrayLike<number>, vertex: number): number {
  const [x, y, z] = [places[3 * vertex]!, places[3 * vertex + 1]!, places[3 * vertex + 2]!];
  let [found, least] = [0, Infinity];
  for (let at = 0; at < skin.length; at += 3 * EVERY) {
    const far = (skin[at]! - x) ** 2 + (skin[at + 1]! - y) ** 2 + (skin[at + 2]! - z) ** 2;
    if (far < least) [found, least] = [at / 3, far];
  }
  return found;
}
