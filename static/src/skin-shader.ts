// What the skin adds to three's physical shader: pores, cropped hair, light that bleeds under the surface.

import { ShaderChunk } from 'three';

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
float stubble(vec3 p) { return noise(p * vec3(3.1, 1.3, 1.3)) * 0.6 + noise(p * vec3(6.3, 2.9, 2.9) + 40.0) * 0.4; }
`;

/** Red light travels farthest in skin: it reaches around the terminator and into the edge of a shadow. */
const SCATTER = /* glsl */ `
const vec3 SCATTER_REACH = vec3(0.21, 0.085, 0.05);
vec3 scatteredCosine(float cosine) {
  vec3 t = clamp((cosine + SCATTER_REACH) / (1.0 + SCATTER_REACH), 0.0, 1.0);
  return t * mix(vec3(1.0), t, SCATTER_REACH);
}
vec3 scatteredShadow(float lit, float cosine) {
  // Beyond the terminator the map only shows the skin shading itself, which the scattered cosine does better.
  float open = mix(lit, 1.0, smoothstep(0.06, -0.12, cosine));
  return pow(vec3(open), vec3(0.8, 0.97, 1.02));
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
  normal = normalize(normal - slope * mix(0.042, 0.10, vHair));
}
`;

const ROUGHNESS = /* glsl */ `
float strandShade = stubble(vRest + 60.0);
roughnessFactor += (pores(vRest * 0.5 + 50.0) - 0.5) * 0.14;
roughnessFactor = mix(roughnessFactor, 0.9, vHair);
diffuseColor.rgb *= mix(1.0, 0.45 + 0.95 * strandShade, vHair);
float aboveNeck = smoothstep(neckFade.x, neckFade.y, vRest.y);
diffuseColor.a *= aboveNeck;
diffuseColor.rgb *= 0.15 + 0.85 * aboveNeck;
`;

/** Hair is no sheet of skin: almost no highlight of its own. */
const HAIR_GLOSS = /* glsl */ `
material.specularColor *= 1.0 - 0.75 * vHair;
material.specularColorBlended *= 1.0 - 0.75 * vHair;
material.sheenColor *= 1.0 - vHair;
`;

interface Program {
  vertexShader: string;
  fragmentShader: string;
  uniforms: Record<string, { value: unknown }>;
}

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
    ['#include <lights_physical_fragment>', `#include <lights_physical_fragment>\n${HAIR_GLOSS}`],
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

/** Three takes 5 samples of a shadow's edge; a large soft edge needs more, or it shows as grain. */
function softerShadows(): string {
  const samples = 14;
  const loop = `for (int s = 0; s < ${samples}; s++) shadow += texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( s, ${samples}, phi ) * radius, shadowCoord.z ) );
				shadow = ( shadow - 1.0 ) / ${samples}.0;`;
  return ShaderChunk.shadowmap_pars_fragment.replace(
    /shadow = \(\s*texture\( shadowMap[^;]*\* 0\.2;/,
    loop,
  );
}

function replaced(source: string, pairs: readonly (readonly [string, string])[]): string {
  for (const [find, put] of pairs) {
    if (!source.includes(find)) throw new Error(`three's shader has no "${find}" any more.`);
    source = source.replace(find, put);
  }
  return source;
}
