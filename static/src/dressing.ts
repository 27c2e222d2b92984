// What a face is drawn in: every mesh gets its material, its shadow, and what its material needs to know of it.

import type { BufferAttribute, BufferGeometry, Mesh, MeshStandardMaterial, Object3D } from 'three';
import { Float32BufferAttribute, MathUtils, Vector3 } from 'three';
import type { EyeSetting } from './eye-shader';
import { addFringe, FRINGE } from './fringe';
import { meshes, nodeName, plainArray } from './gltf-nodes';
import type { Setting } from './materials';
import { createMaterial } from './materials';
import { strandSides } from './strand-sides';
import { strandTangents } from './strand-tangents';
import type { FaceMaps } from './textures';

const MILLIMETRES = 1000;
/** What is wet below this height is in the mouth; light fades between lips and throat [m, head frame]. */
const MOUTH_TOP = -0.04;
const LIPS = 0.094;
const THROAT = 0.045;
const DARKEST = { wet: 0.4, teeth: 0.6 };
/** A face that reaches lower than this [m] has a neck, which fades from its cut, uneven by so many mm, up to there. */
const NECK_BELOW = -0.14;
const NECK_END = 13;
const NECK_FADE = 60;
/** What is blended comes after what is opaque: skin, which fades at the neck, then corneas, then hair over both, its thin parts last. */
const DRAWN_AFTER: Record<string, number> = { skin: 1, cornea: 2, hair: 3, [FRINGE]: 4 };

/** Give every mesh its material, its shadow and its place in the drawing order. */
export function dress(
  root: Object3D,
  maps: FaceMaps,
  eyes: Readonly<Record<string, EyeSetting>>,
  { neckFade, peelCut }: Pick<Setting, 'neckFade' | 'peelCut'>,
): void {
  root.updateMatrixWorld(true);
  for (const mesh of meshes(root)) {
    const kind = (mesh.userData.material as string | undefined) ?? 'skin';
    const inMouth = (kind === 'wet' || kind === 'teeth') && isInMouth(mesh);
    if (inMouth) darkenThroat(mesh, DARKEST[kind]);
    mesh.visible = mesh.userData.role !== 'tissue';
    const { map } = mesh.material as MeshStandardMaterial;
    const setting = {
      vertexColors: mesh.geometry.hasAttribute('color'),
      map,
      inMouth,
      neckFade,
      peelCut,
      maps: mesh.geometry.hasAttribute('uv') ? maps : null,
      eye: eyeOf(mesh, eyes),
    };
    mesh.material = createMaterial(kind, setting);
    mesh.castShadow = kind !== 'cornea' && kind !== 'eye';
    mesh.receiveShadow = true;
    mesh.frustumCulled = false;
    mesh.renderOrder = DRAWN_AFTER[kind] ?? 0;
    if (kind === 'hair') addStrandAttributes(mesh);
    if (kind === 'hair' && map !== null) {
      addFringe(mesh, createMaterial(FRINGE, setting), DRAWN_AFTER[FRINGE]!);
    }
    if (kind === 'skin') {
      const positions = mesh.geometry.getAttribute('position');
      mesh.geometry.setAttribute('restPosition', positions.clone());
    }
  }
}

/** The eye that a ball or cornea turns with. */
function eyeOf(mesh: Mesh, eyes: Readonly<Record<string, EyeSetting>>): EyeSetting | null {
  const turning = mesh.parent === null ? '' : nodeName(mesh.parent);
  return eyes[turning] ?? null;
}

function addStrandAttributes({ geometry }: Mesh<BufferGeometry>): void {
  const index = geometry.getIndex();
  if (index === null) throw new Error('Strands of hair have no triangles.');
  const positions = plainArray(geometry.getAttribute('position'));
  const triangles = plainArray(index);
  const tangents = strandTangents(positions, triangles);
  geometry.setAttribute('strandTangent', new Float32BufferAttribute(tangents, 4));
  if (geometry.hasAttribute('uv')) return; // cards are as wide as they are
  const sides = strandSides(positions, triangles);
  geometry.setAttribute('strandSide', new Float32BufferAttribute(sides, 4));
}

function isInMouth(mesh: Mesh<BufferGeometry>): boolean {
  mesh.geometry.computeBoundingSphere();
  return mesh.localToWorld(mesh.geometry.boundingSphere!.center.clone()).y < MOUTH_TOP;
}

/** Light hardly reaches the throat, and a shadow map alone does not show it. */
function darkenThroat(mesh: Mesh<BufferGeometry>, darkest: number): void {
  const positions = mesh.geometry.getAttribute('position');
  const colors = mesh.geometry.getAttribute('color') as BufferAttribute | undefined;
  if (colors === undefined) return;
  const at = new Vector3();
  for (let i = 0; i < positions.count; i++) {
    mesh.localToWorld(at.fromBufferAttribute(positions, i));
    const light = MathUtils.lerp(darkest, 1, MathUtils.smoothstep(at.z, THROAT, LIPS));
    colors.setXYZ(i, colors.getX(i) * light, colors.getY(i) * light, colors.getZ(i) * light);
  }
}

/** Heights [mm] between which skin fades above the cut of the neck; null for a mask without a neck. */
export function neckFadeOf(root: Object3D): readonly [number, number] | null {
  let lowest = Infinity;
  for (const mesh of meshes(root)) {
    if (mesh.userData.material !== 'skin') continue;
    mesh.geometry.computeBoundingBox();
    lowest = Math.min(lowest, mesh.geometry.boundingBox!.min.y);
  }
  if (lowest > NECK_BELOW) return null;
  return [lowest * MILLIMETRES + NECK_END, lowest * MILLIMETRES + NECK_FADE];
}
