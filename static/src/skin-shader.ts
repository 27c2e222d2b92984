// What the skin adds to three's physical shader: pores, tone, moisture, cropped hair, light that bleeds under it.

import { ShaderChunk } from 'three';
import type { Program } from './shader-edit';
import { replaced } from './shader-edit';
import { softerShadows } from './soft-shadows';

/** Value noise on the rest position, so that pores stay on the skin while it deforms. Lengths in mm. */
const NOISE = /* glsl */ `
varying vec3 vRest;
varying float vHair;
uniform vec2 neckFade;

float hash(vec3 p) {
  p = fract(p * 0.3183099 + 0.1) * 17.0;
  return fract(p.x * p.y * p.z * (p.x + p.y + p.z));
}
float noise(vec3 x) {
  vec3 i = floor(x);
  vec3 f = fract(x);
  f = f * f * (3.0 - 2.0 * f);
  return mix(
    mix(mix(hash(i), hash(i + vec3(1, 0, 0)), f.x), mix(hash(i + vec3(0, 1, 0)), hash(i + vec3(1, 1, 0)), f.x), f.y),
    mix(mix(hash(i + vec3(0, 0, 1)), hash(i + vec3(1, 0, 1)), f.x), mix(hash(i + vec3(0, 1, 1)), hash(i + vec3(1, 1, 1)), f.x), f.y),
    f.z);
}
float pores(vec3 p) { return noise(p * 1.1) * 0.55 + noise(p * 2.3) * 0.45; }
float stubble(vec3 p) { return noise(p * vec3(2.3, 1.1, 1.1)) * 0.6 + noise(p * vec3(4.1, 2.1, 2.1) + 40.0) * 0.4; }
`;

/** Red light travels farthest in skin: it reaches around the terminator and into the edge of a shadow. */
const SCATTER = /* glsl */ `
const vec3 CROPPED_HAIR = vec3(0.034, 0.021, 0.0145);
const vec3 SCATTER_REACH = vec3(0.15, 0.07, 0.05);
vec3 scatteredCosine(float cosine) {
  vec3 t = clamp((cosine + SCATTER_REACH) / (1.0 + SCATTER_REACH), 0.0, 1.0);
  return t * mix(vec3(1.0), t, SCATTER_REACH);
}
vec3 scatteredShadow(float lit, float cosine) {
  // Beyond the terminator the map only shows the skin shading itself, which the scattered cosine does better.
  float open = mix(lit, 1.0, 0.55 * smoothstep(0.06, -0.12, cosine));
  return pow(vec3(max(open, 0.0)), vec3(0.8, 0.97, 1.02));
}
`;

const PORES = /* glsl */ `
{
  vec3 at = vRest + 200.0;
  const float STEP = 0.25;
  float here = pores(at);
  vec3 slope = vec3(pores(at + vec3(STEP, 0, 0)), pores(at + vec3(0, STEP, 0)), pores(at + vec3(0, 0, STEP)));
  slope = (viewMatrix * vec4((slope - here) / STEP, 0.0)).xyz;
  slope -= normal * dot(normal, slope);
  normal = normalize(normal - slope * mix(0.05 * (1.0 - mucosa), 0.10, hairCover));
}
`;

/**
 * The redder, the wetter: lips, the rims and insides of the lids and the mouth are mucosa, and their paint says so.
 * Skin is drier, and neither its tone nor its oil is even.
 */
const ROUGHNESS = /* glsl */ `
float redness = diffuseColor.r / max(diffuseColor.g, 1e-3);
float lip = smoothstep(2.5, 3.3, redness) * (1.0 - vHair);
float mucosa = smoothstep(4.5, 8.0, redness) * (1.0 - vHair);
float oil = pores(vRest * 0.5 + 50.0);
float blotch = noise(vRest * 0.13 + 30.0) - 0.5;
float freckle = noise(vRest * 0.62 + 90.0) - 0.5;
diffuseColor.rgb *= 1.0 + (1.0 - mucosa) * (0.10 * freckle * vec3(0.6, 1.0, 1.15) + 0.09 * blotch * vec3(0.3, 1.0, 0.9));
roughnessFactor += (oil - 0.5) * 0.22;
roughnessFactor = mix(roughnessFactor, 0.36, 0.8 * lip * (1.0 - mucosa));
float hairCover = 0.0;
if (vHair > 0.01) {
  float strand = stubble(vRest + 60.0);
  // Single hairs where they are few, a shade over all of the scalp where they are many.
  float grown = smoothstep(0.05, 0.95, vHair);
  hairCover = grown * mix(smoothstep(0.25, 0.75, strand), 1.0, grown);
  diffuseColor.rgb = mix(diffuseColor.rgb, CROPPED_HAIR * (0.6 + 0.8 * strand), 0.93 * hairCover);
  roughnessFactor = mix(roughnessFactor, 0.9, hairCover);
}
float aboveNeck = smoothstep(neckFade.x, neckFade.y, vRest.y);
diffuseColor.a *= aboveNeck;
diffuseColor.rgb *= 0.15 + 0.85 * aboveNeck;
`;

/** Hair is no sheet of skin, and the mouth mirrors no studio: little highlight of their own. */
const GLOSS = /* glsl */ `
float gloss = (0.55 + 0.9 * oil) * (1.0 - 0.75 * hairCover) * (1.0 - 0.8 * mucosa);
material.specularColor *= gloss;
material.specularColorBlended *= gloss;
material.sheenColor *= (1.0 - hairCover) * (1.0 - mucosa) * (1.0 - lip);
`;

/**
 * Change the program of a physical material into skin. Needs attributes `restPosition` [m] and `_hair`.
 * @throws Error when three's shader no longer has a line that is replaced here.
 */
export function makeSkin(program: Program, neckFade: { value: unknown }): void {
  program.uniforms.neckFade = neckFade;
  program.vertexShader = replaced(program.vertexShader, [
    [
      '#include <common>',
      '#include <common>\nattribute vec3 restPosition;\nattribute float _hair;\nvarying vec3 vRest;\nvarying float vHair;',
    ],
    [
      '#include <begin_vertex>',
      '#include <begin_vertex>\nvRest = restPosition * 1000.0;\nvHair = _hair;',
    ],
  ]);
  program.fragmentShader = replaced(program.fragmentShader, [
    ['#include <common>', `#include <common>\n${NOISE}${SCATTER}`],
    ['#include <normal_fragment_maps>', `#include <normal_fragment_maps>\n${PORES}`],
    ['#include <roughnessmap_fragment>', `#include <roughnessmap_fragment>\n${ROUGHNESS}`],
    ['#include <lights_physical_fragment>', `#include <lights_physical_fragment>\n${GLOSS}`],
    ['#include <lights_physical_pars_fragment>', scatteringLights()],
    ['#include <lights_fragment_begin>', scatteringShadows()],
    ['#include <shadowmap_pars_fragment>', softerShadows()],
  ]);
}

function scatteringLights(): string {
  return replaced(ShaderChunk.lights_physical_pars_fragment, [
    [
      'reflectedLight.directDiffuse += irradiance * diffuseBRDF * ( 1.0 - F );',
      `vec3 scattered = scatteredCosine( dot( geometryNormal, directLight.direction ) ) * directLight.color;
	reflectedLight.directDiffuse += mix( scattered, irradiance, vHair ) * diffuseBRDF * ( 1.0 - F );`,
    ],
  ]);
}

function scatteringShadows(): string {
  return ShaderChunk.lights_fragment_begin.replace(
    /directLight\.color \*= \( directLight\.visible && receiveShadow \) \? (getShadow\( directionalShadowMap.*?\)) : 1\.0;/,
    'directLight.color *= scatteredShadow( ( directLight.visible && receiveShadow ) ? $1 : 1.0, dot( geometryNormal, directLight.direction ) );',
  );
}
