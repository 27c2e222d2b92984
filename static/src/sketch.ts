// What a slow device shows first: the face in plain materials, which are compiled at once.

import type { Material, MeshStandardMaterial, Object3D, ShaderMaterial, Texture } from 'three';
import { BufferGeometry, Color, DataTexture, Float32BufferAttribute, Group, Mesh } from 'three';
import { FRINGE } from './fringe';
import { NOTHING_PEELED } from './peel';
import { sketchMaterial } from './sketch-material';

/** Where a surface brings no colours: flesh, and hair. */
const FLESH = 0xd9a58a;
const HAIR = 0x2a1a12;
/** What they lack of the studio's light, most of it mirrored, by which colours are made brighter. */
const SKIN_GAIN = 1.3;
const HAIR_GAIN = 2.4;
/** What its own materials darken or see through stays out of a sketch. */
const LEFT_OUT = ['cornea', 'wet', FRINGE];

/**
 * Put plain materials on all that is seen of a face.
 * @param peelCut what of the skin lies further to the left is peeled off [m].
 * @returns what gives it its own back.
 */
export function sketch(root: Object3D, peelCut = { value: NOTHING_PEELED }): () => void {
  const own: [Mesh, Material | Material[], boolean][] = [];
  const plain = new Map<string, ShaderMaterial>();
  root.traverse((node) => {
    if (!(node instanceof Mesh) || !node.visible) return;
    const kind = (node.userData.material as string | undefined) ?? 'skin';
    own.push([node, node.material as Material, node.visible]);
    node.visible = !LEFT_OUT.includes(kind);
    const { map } = node.material as MeshStandardMaterial;
    const coloured = (node as Mesh).geometry.hasAttribute('color');
    const key = `${kind === 'hair'} ${coloured} ${map?.uuid ?? ''}`;
    const material = plain.get(key) ?? drawnPlainly(kind === 'hair', coloured, map, peelCut);
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

/**
 * Something of each kind that a sketch has, too small to be seen: to be drawn once while the face is on its way,
 * so that the programs are there before it.
 */
export function sketchSample(): { root: Group; dispose: () => void } {
  const geometry = new BufferGeometry();
  for (const [name, size] of [
    ['position', 3],
    ['normal', 3],
    ['color', 3],
    ['uv', 2],
  ] as const) {
    geometry.setAttribute(name, new Float32BufferAttribute(new Float32Array(3 * size), size));
  }
  const map = new DataTexture(new Uint8Array([0, 0, 0, 0]), 1, 1);
  map.needsUpdate = true;
  const materials = [drawnPlainly(false, true, null), drawnPlainly(true, true, map)];
  const root = new Group().add(
    ...materials.map((material) => {
      const mesh = new Mesh(geometry, material);
      mesh.frustumCulled = false;
      return mesh;
    }),
  );
  return {
    root,
    dispose: () => {
      root.removeFromParent();
      for (const thing of [...materials, geometry, map]) thing.dispose();
    },
  };
}

function drawnPlainly(
  hair: boolean,
  coloured: boolean,
  map: Texture | null,
  peelCut = { value: NOTHING_PEELED },
): ShaderMaterial {
  const bare = new Color(hair ? HAIR : FLESH);
  return sketchMaterial({
    vertexColors: coloured,
    color: (coloured ? new Color(0xffffff) : bare).multiplyScalar(hair ? HAIR_GAIN : SKIN_GAIN),
    map: hair ? map : null,
    peelCut,
  });
}
