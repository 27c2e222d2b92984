// What a slow device shows first: the face in plain materials, which are compiled at once.

import type { Material, MeshStandardMaterial, Object3D } from 'three';
import { Color, DoubleSide, Mesh, MeshLambertMaterial } from 'three';

/** Where a surface brings no colours: flesh, and hair. */
const FLESH = 0xd9a58a;
const HAIR = 0x2a1a12;
/** What they lack of the studio's light, most of it mirrored, by which colours are made brighter. */
const SKIN_GAIN = 1.3;
const HAIR_GAIN = 2.4;
/** What its own materials darken or see through stays out of a sketch. */
const LEFT_OUT = ['cornea', 'wet'];

/**
 * Put plain materials on all that is seen of a face.
 * @returns what gives it its own back.
 */
export function sketch(root: Object3D): () => void {
  const own: [Mesh, Material | Material[], boolean][] = [];
  const plain = new Map<string, MeshLambertMaterial>();
  root.traverse((node) => {
    if (!(node instanceof Mesh) || !node.visible) return;
    const kind = (node.userData.material as string | undefined) ?? 'skin';
    own.push([node, node.material as Material, node.visible]);
    node.visible = !LEFT_OUT.includes(kind);
    const { map } = node.material as MeshStandardMaterial;
    const coloured = (node as Mesh).geometry.hasAttribute('color');
    const key = `${kind === 'hair'} ${coloured} ${map?.uuid ?? ''}`;
    const material = plain.get(key) ?? drawnPlainly(kind === 'hair', coloured, map);
    plain.set(key, material);
    node.material = material;
  });
  return () => {
    for (const [mesh, material, visible] of own) {
      mesh.material = material;
      mesh.visible = visible;
    }
    for (const material of plain.values()) material.dispose();
  };
}

function drawnPlainly(
  hair: boolean,
  coloured: boolean,
  map: MeshStandardMaterial['map'],
): MeshLambertMaterial {
  const bare = new Color(hair ? HAIR : FLESH);
  return new MeshLambertMaterial({
    vertexColors: coloured,
    color: (coloured ? new Color(0xffffff) : bare).multiplyScalar(hair ? HAIR_GAIN : SKIN_GAIN),
    // Cards of hair are cut out of their picture; strands are as they are.
    ...(hair ? { side: DoubleSide, alphaTest: map === null ? 0 : 0.35 } : {}),
    map,
  });
}
