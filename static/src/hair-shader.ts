// What hair adds to three's standard shader: a strand is never thinner than a pixel, only fainter.

import { ShaderChunk } from 'three';
import type { Program } from './shader-edit';
import { replaced } from './shader-edit';

const WIDEN = /* glsl */ `
#include <project_vertex>
{
  vec3 half_ = (modelViewMatrix * vec4(strandSide.xyz, 0.0)).xyz;
  float width = length(half_);
  float pixel = -mvPosition.z / (projectionMatrix[1][1] * max(drawnHeight, 1.0));
  float drawn = max(width, LEAST_PIXELS * pixel);
  vec2 across = half_.xy / max(length(half_.xy), 1e-9);
  // A hair is round: seen edge on, its ribbon is as wide as seen flat.
  mvPosition.xyz += strandSide.w * (vec3(across * drawn, 0.0) - half_);
  gl_Position = projectionMatrix * mvPosition;
  vCover = width / drawn;
}
`;

/** Half the least width of a drawn strand, in pixels across half the picture's height. */
const LEAST_PIXELS = '1.3';

/**
 * Change the program of a standard material into hair. Needs the attribute `strandSide` of strand-sides.ts.
 * @throws Error when three's shader no longer has a line that is replaced here.
 */
export function makeHair(program: Program, drawnHeight: { value: number }): void {
  program.uniforms.drawnHeight = drawnHeight;
  program.vertexShader = replaced(program.vertexShader, [
    [
      '#include <common>',
      `#define LEAST_PIXELS ${LEAST_PIXELS}\n#include <common>\nattribute vec4 strandSide;\nuniform float drawnHeight;\nvarying float vCover;`,
    ],
    ['#include <project_vertex>', WIDEN],
  ]);
  program.fragmentShader = replaced(program.fragmentShader, [
    ['#include <common>', '#include <common>\nvarying float vCover;'],
    ['#include <color_fragment>', '#include <color_fragment>\ndiffuseColor.a *= vCover;'],
    ['#include <normal_fragment_begin>', unflippedNormals()],
  ]);
}

/** Both faces of a ribbon are lit as the skin under it is, or half of all hairs would be black. */
function unflippedNormals(): string {
  return replaced(ShaderChunk.normal_fragment_begin, [['gl_FrontFacing ? 1.0 : - 1.0', '1.0']]);
}
