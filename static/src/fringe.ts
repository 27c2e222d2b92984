// The thin parts of hair cards: drawn once more, blended over all that is solid, so that an edge of hair is as soft
// as hair is. Samples of a pixel know four shades of it, and of cards one behind the other all the same four.

import type { BufferGeometry, Material } from 'three';
import { Mesh } from 'three';

/** What a fringe is called among kinds of surfaces; see dressing.ts. */
export const FRINGE = 'fringe';

/** Add the thin parts of `cards` to it; they go with it and share its geometry, and throw no shadow of their own. */
export function addFringe(cards: Mesh<BufferGeometry>, material: Material, order: number): void {
  const fringe = new Mesh(cards.geometry, material);
  fringe.userData = { material: FRINGE, role: 'strands' };
  fringe.receiveShadow = true;
  fringe.frustumCulled = false;
  fringe.renderOrder = order;
  cards.add(fringe);
}
