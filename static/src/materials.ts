// How each kind of surface takes light: skin, eyes, wet mucosa, teeth, hair.

import type { Material, MeshPhysicalMaterialParameters, Texture } from 'three';
import {
  AdditiveBlending,
  DoubleSide,
  LessDepth,
  MeshPhysicalMaterial,
  NoBlending,
  NormalBlending,
  Vector2,
} from 'three';
import type { EyeSetting } from './eye-shader';
import { makeCornea, makeEyeball } from './eye-shader';
import { FRINGE } from './fringe';
import { makeHair } from './hair-shader';
import { makeCornerFlesh, makeOral } from './mouth-shader';
import { createPores } from './pores';
import type { Program } from './shader-edit';
import { makeSkin } from './skin-shader';
import { softenShadows } from './soft-shadows';
import { FaceMaps } from './textures';

/** Where a surface lies, as far as it matters to its light. */
export interface Setting {
  vertexColors: boolean;
  /** In the mouth, where less of the studio is mirrored the deeper it lies. */
  inMouth: boolean;
  /** The picture that came with the surface; hair with one is made of cards, without one of strands. */
  map: Texture | null;
  /** The neck dissolves into the background between these heights [mm]; null where there is no cut to hide. */
  neckFade: readonly [number, number] | null;
  /** What of the skin lies further to the left is peeled off [m]. */
  peelCut: { value: number };
  /** The face's maps; null for a surface without texture coordinates. */
  maps: FaceMaps | null;
  /** Of an eyeball or cornea, the eye it belongs to. */
  eye: EyeSetting | null;
}

/** A fade that never begins. */
const NO_FADE = [-2000, -1999] as const;

export function createMaterial(
  kind: string,
  { vertexColors, inMouth, map, neckFade, peelCut, maps, eye }: Setting,
): Material {
  switch (kind) {
    case 'eye':
      return eyeball(vertexColors, eye);
    case 'cornea':
      return eye === null ? clearCornea() : cornea(eye);
    case 'wet':
      return inMouth
        ? wet(makeOral, {
            vertexColors,
            roughness: 0.42,
            specularIntensity: 0.4,
            clearcoat: 0.45,
            clearcoatRoughness: 0.18,
            envMapIntensity: 0.4,
          })
        : wet(makeCornerFlesh, {
            vertexColors,
            roughness: 0.42,
            specularIntensity: 0.3,
            clearcoat: 0.16,
            clearcoatRoughness: 0.16,
            envMapIntensity: 0.28,
          });
    case 'teeth':
      return wet(makeOral, {
        vertexColors,
        roughness: 0.38,
        // Enamel is denser than skin, and wet.
        ior: 1.62,
        specularIntensity: 0.4,
        clearcoat: 0.6,
        clearcoatRoughness: 0.09,
        envMapIntensity: 0.5,
      });
    case 'hair':
      return map === null ? strands(vertexColors) : cards(vertexColors, map, false);
    case FRINGE:
      if (map === null) throw new Error('A fringe is cut out of a picture of hair.');
      return cards(vertexColors, map, true);
    default:
      return skin(vertexColors, { neckFade, peelCut, maps });
  }
}

/** See mouth-shader.ts. */
function wet(make: (program: Program) => void, look: MeshPhysicalMaterialParameters): Material {
  const material = new MeshPhysicalMaterial(look);
  material.onBeforeCompile = make;
  return material;
}

function skin(
  vertexColors: boolean,
  { neckFade: fade, peelCut, maps }: Pick<Setting, 'neckFade' | 'peelCut' | 'maps'>,
): Material {
  const material = new MeshPhysicalMaterial({
    vertexColors,
    color: vertexColors ? 0xffffff : 0xd9a58a,
    roughness: 0.5,
    // Skin's outermost layer, the stratum corneum: 2.8 % of light from straight ahead.
    ior: 1.4,
    transparent: fade !== null,
  });
  const neckFade = { value: new Vector2(...(fade ?? NO_FADE)) };
  const { uniforms, shown } = maps ?? new FaceMaps();
  if (maps !== null) material.defines = { ...material.defines, SKIN_MAPS: '' };
  const poreMap = { value: maps === null ? null : pores() };
  material.onBeforeCompile = (program) => {
    makeSkin(program, {
      neckFade,
      peelCut,
      mapsShown: shown,
      albedoMap: uniforms.albedo,
      reliefMap: uniforms.normal,
      ormMap: uniforms.orm,
      wrinkleMap: uniforms.wrinkles,
      poreMap,
    });
  };
  return material;
}

let sharedPores: Texture | null = null;

/** One tile for all faces. */
function pores(): Texture {
  return (sharedPores ??= createPores());
}

/** Strands are blended, so that those thinner than a pixel fade instead of breaking into dots. */
function strands(vertexColors: boolean): Material {
  const material = new MeshPhysicalMaterial({
    vertexColors,
    color: vertexColors ? 0xffffff : 0x2a1a12,
    roughness: 0.7,
    side: DoubleSide,
    transparent: true,
    depthWrite: false,
  });
  const drawnHeight = { value: 0 };
  const size = new Vector2();
  material.onBeforeRender = (renderer) => {
    drawnHeight.value = renderer.getDrawingBufferSize(size).y;
  };
  material.onBeforeCompile = (program) => {
    makeHair(program, { cards: false, drawnHeight, fringe: { value: false } });
  };
  return material;
}

/** The solid of cards, in any order; their thin parts are blended over it: see fringe.ts. */
function cards(vertexColors: boolean, map: Texture, fringe: boolean): Material {
  map.anisotropy = 2;
  const material = new MeshPhysicalMaterial({
    vertexColors,
    color: 0xffffff,
    map,
    roughness: 0.75,
    side: DoubleSide,
    alphaTest: 0.35,
    // In two draws those faces that are seen from behind would be lit from behind.
    forceSinglePass: true,
    // Skin that fades at the neck is drawn with what is transparent, so that cards, which come after it,
    // must be too.
    transparent: true,
    blending: fringe ? NormalBlending : NoBlending,
    depthWrite: !fringe,
    depthFunc: LessDepth,
  });
  material.onBeforeCompile = (program) => {
    makeHair(program, { cards: true, drawnHeight: { value: 0 }, fringe: { value: fringe } });
  };
  // One program draws both.
  material.customProgramCacheKey = () => 'hair cards';
  return material;
}

function eyeball(vertexColors: boolean, eye: EyeSetting | null): Material {
  const material = new MeshPhysicalMaterial({
    vertexColors,
    roughness: 0.4,
    specularIntensity: 0.35,
    clearcoat: 0.75,
    clearcoatRoughness: 0.07,
  });
  material.onBeforeCompile = (program) => {
    if (eye === null) softenShadows(program);
    else makeEyeball(program, eye);
  };
  material.customProgramCacheKey = () => (eye === null ? 'plain eye' : 'eye');
  return material;
}

/** Iris and highlights in one, over the ball's own iris. */
function cornea(eye: EyeSetting): Material {
  const material = new MeshPhysicalMaterial({
    roughness: 0.6,
    specularIntensity: 0,
    transparent: true,
    premultipliedAlpha: true,
    depthWrite: false,
    clearcoat: 1,
    clearcoatRoughness: 0.025,
    envMapIntensity: 1.2,
  });
  material.onBeforeCompile = (program) => {
    makeCornea(program, eye);
  };
  return material;
}

/** Only its highlights are seen, added to the iris behind it. */
function clearCornea(): Material {
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
