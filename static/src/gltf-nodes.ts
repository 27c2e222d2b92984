// What GLTFLoader makes of a file: its meshes, their names, and plain arrays of their numbers.

import type { BufferAttribute, BufferGeometry, InterleavedBufferAttribute, Object3D } from 'three';
import { DynamicDrawUsage, Float32BufferAttribute, Mesh } from 'three';

export function meshes(root: Object3D): Mesh<BufferGeometry>[] {
  const found: Mesh<BufferGeometry>[] = [];
  root.traverse((node) => {
    if (node instanceof Mesh) found.push(node as Mesh<BufferGeometry>);
  });
  return found;
}

/** The loader takes dots out of names and keeps the original beside it. */
export function nodeName(node: Object3D): string {
  return (node.userData.name as string | undefined) ?? node.name;
}

export function plainArray(
  attribute: BufferAttribute | InterleavedBufferAttribute,
): ArrayLike<number> {
  if (!('isInterleavedBufferAttribute' in attribute)) return attribute.array;
  const out = new Float32Array(attribute.count * attribute.itemSize);
  for (let i = 0; i < out.length; i++) {
    out[i] = attribute.getComponent(Math.floor(i / attribute.itemSize), i % attribute.itemSize);
  }
  return out;
}

/** Put an array in place of an attribute, for values that change from frame to frame. */
export function dynamic(
  geometry: BufferGeometry,
  name: string,
  array: Float32Array,
  size = 3,
): BufferAttribute {
  const attribute = new Float32BufferAttribute(array, size);
  attribute.array = array;
  attribute.setUsage(DynamicDrawUsage);
  geometry.setAttribute(name, attribute);
  return attribute;
}
