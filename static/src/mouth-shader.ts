// What wet flesh and teeth add to three's physical shader: light that wanders in them, and a dark behind.

import type { Program } from './shader-edit';
import { replaced } from './shader-edit';
import { softenShadows } from './soft-shadows';

/**
 * Their vertex colours tell how much light reaches a place of the mouth: what lies in the dark has no lamp to
 * mirror either.
 */
const DIMMED = /* glsl */ `
#include <lights_fragment_end>
{
  #ifdef USE_COLOR
    float reached = clamp(vColor.r / 0.45, 0.0, 1.0);
    reached *= reached;
  #else
    float reached = 1.0;
  #endif
  reflectedLight.directSpecular *= reached;
  reflectedLight.indirectSpecular *= reached;
  clearcoatSpecularDirect *= reached;
  clearcoatSpecularIndirect *= reached;
}
`;

/** Enamel and mucosa let light in and out beside where it came in: lit sides run into dark ones softly. */
const SOFT_LIGHT = /* glsl */ `
#include <normal_fragment_maps>
normal = normalize(mix(normal, normalize(vViewPosition), 0.22));
`;

/**
 * Change the program of a physical material with a clear coat into a surface of the mouth.
 * @throws Error when three's shader no longer has a line that is replaced here.
 */
export function makeOral(program: Program): void {
  program.fragmentShader = replaced(program.fragmentShader, [
    ['#include <normal_fragment_maps>', SOFT_LIGHT],
    ['#include <lights_fragment_end>', DIMMED],
  ]);
  softenShadows(program);
}

/** The flesh beside an eye is as soft, and lies between lids that hide it from most lamps. */
const BETWEEN_LIDS = /* glsl */ `
#include <normal_fragment_maps>
normal = normalize(mix(normal, normalize(vViewPosition), 0.25));
`;

/** Seen along its bed it would mirror a room that the lids keep from it. */
const LITTLE_ROOM = /* glsl */ `
#include <lights_fragment_end>
reflectedLight.directSpecular *= 0.5;
reflectedLight.indirectSpecular *= 0.2;
clearcoatSpecularDirect *= 0.6;
clearcoatSpecularIndirect *= 0.2;
`;

/**
 * Change the program of a physical material into the wet flesh in the corners of an eye.
 * @throws Error when three's shader no longer has a line that is replaced here.
 */
export function makeCornerFlesh(program: Program): void {
  program.fragmentShader = replaced(program.fragmentShader, [
    ['#include <normal_fragment_maps>', BETWEEN_LIDS],
    ['#include <lights_fragment_end>', LITTLE_ROOM],
  ]);
  softenShadows(program);
}
