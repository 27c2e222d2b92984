// From light to picture: AgX, which keeps the hue of skin in shade and highlight, with a little more contrast.

import type { WebGLRenderer } from 'three';
import { AgXToneMapping, ShaderChunk } from 'three';
import { replaced } from './shader-edit';

/** AgX as it comes is flat, meant to be graded; these are the numbers of its look. */
const CONTRAST = 1.16;
const SATURATION = 1.34;
const EXPOSURE = 1.42;

/** AgX' way back from its own primaries, before which its look belongs. */
const PLACE = 'color = AgXOutsetMatrix * color;';
/** Luminance weights are Rec. 709's. */
const LOOK = /* glsl */ `
	color = pow( max( color, vec3( 0.0 ) ), vec3( ${CONTRAST.toFixed(2)} ) );
	color = mix( vec3( dot( color, vec3( 0.2126, 0.7152, 0.0722 ) ) ), color, ${SATURATION.toFixed(2)} );
`;

/** Set the renderer's exposure and curve. @throws Error when three's shader has no such line any more. */
export function exposeSkin(renderer: WebGLRenderer): void {
  if (!ShaderChunk.tonemapping_pars_fragment.includes(LOOK)) {
    ShaderChunk.tonemapping_pars_fragment = replaced(ShaderChunk.tonemapping_pars_fragment, [
      [PLACE, `${LOOK}\t${PLACE}`],
    ]);
  }
  renderer.toneMapping = AgXToneMapping;
  renderer.toneMappingExposure = EXPOSURE;
}
