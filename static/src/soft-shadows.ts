// Shadows with a smooth edge, on skin and on what is wet beside it.

import { ShaderChunk } from 'three';
import type { Program } from './shader-edit';
import { replaced } from './shader-edit';

/** Three takes 5 samples of a shadow's edge; a large soft edge needs more, or it shows as grain. */
export function softerShadows(): string {
  const samples = 14;
  const loop = `for (int s = 0; s < ${samples}; s++) shadow += texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( s, ${samples}, phi ) * radius, shadowCoord.z ) );
				shadow = ( shadow - 1.0 ) / ${samples}.0;`;
  return ShaderChunk.shadowmap_pars_fragment.replace(
    /shadow = \(\s*texture\( shadowMap[^;]*\* 0\.2;/,
    loop,
  );
}

/** Give a material's program such shadows. */
export function softenShadows(program: Program): void {
  program.fragmentShader = replaced(program.fragmentShader, [
    ['#include <shadowmap_pars_fragment>', softerShadows()],
  ]);
}
