// How each kind of surface takes light: skin, eyes, wet mucosa, teeth, hair.

import type { Material } from 'three';
import {
  AdditiveBlending,
  Color,
  DoubleSide,
  MeshPhysicalMaterial,
  MeshStandardMaterial,
  Vector2,
} from 'three';
import { makeSkin } from './skin-shader';

/** The neck dissolves into the background between these heights [mm], where the mesh is cut. */
const NECK_FADE = new Vector2(-181, -138);
/** A fade that never begins, for faces without a neck. */
const NO_FADE = new Vector2(-2000, -1999);

export function createMaterial(kind: string, vertexColors: boolean, hasNeck: boolean): Material {
  switch (kind) {
    case 'eye':
      return new MeshPhysicalMaterial({
        vertexColors,
        roughness: 0.22,
        specularIntensity: 0.5,
        clearcoat: 0.5,
        clearcoatRoughness: 0.06,
        envMapIntensity: 0.9,
      });
    case 'cornea':
      return cornea();
    case 'wet':
      return new MeshPhysicalMaterial({
        vertexColors,
        roughness: 0.3,
        clearcoat: 0.55,
        clearcoatRoughness: 0.22,
      });
    case 'teeth':
      return new MeshPhysicalMaterial({
        vertexColors,
        roughness: 0.28,
        clearcoat: 0.35,
        clearcoatRoughness: 0.15,
        envMapIntensity: 0.8,
      });
    case 'hair':
      return new MeshStandardMaterial({
        vertexColors,
        color: vertexColors ? 0xffffff : 0x2a1a12,
        roughness: 0.75,
        side: DoubleSide,
      });
    default:
      return skin(vertexColors, hasNeck);
  }
}

function skin(vertexColors: boolean, hasNeck: boolean): Material {
  const material = new MeshPhysicalMaterial({
    vertexColors,
    color: vertexColors ? 0xffffff : 0xd9a58a,
    roughness: 0.5,
    specularIntensity: 0.46,
    sheen: 0.22,
    sheenRoughness: 0.45,
    sheenColor: new Color(0.9, 0.48, 0.38),
    transparent: hasNeck,
  });
  const neckFade = { value: hasNeck ? NECK_FADE : NO_FADE };
  material.onBeforeCompile = (program) => {
    makeSkin(program, neckFade);
  };
  return material;
}

/** Only its highlights are seen, added to the iris behind it. */
function cornea(): Material {
  return new MeshPhysicalMaterial({
    color: 0x000000,
    roughness: 0.03,
    transparent: true,
    blending: AdditiveBlending,
    depthWrite: false,
    clearcoat: 0.6,
    clearcoatRoughness: 0.02,
    envMapIntensity: 1.25,
  });
}
