// What the skin adds to three's physical shader: its maps, wrinkles and pores, and light that bleeds under it.

import { PEEL_FRAGMENT, PEEL_VERTEX } from './peel';
import type { Program } from './shader-edit';
import { replaced } from './shader-edit';
import { SKIN_LIGHT, SKIN_OPENNESS, scatteringShadows, scatteringSurroundings } from './skin-light';
import { softerShadows } from './soft-shadows';

/** Uniforms of the skin. Those of maps are read only where the geometry has texture coordinates. */
export interface SkinUniforms {
  /** Heights between which the neck leaves the light, for the background [mm]. */
  neckFade: { value: unknown };
  /** What lies further to the left of a face that is peeled is left out [m]. */
  peelCut: { value: unknown };
  /** 0 vertex colours, 1 maps. */
  mapsShown: { value: unknown };
  albedoMap: { value: unknown };
  reliefMap: { value: unknown };
  ormMap: { value: unknown };
  wrinkleMap: { value: unknown };
  poreMap: { value: unknown };
}

/** Value noise on the rest position, so that pores stay on the skin while it deforms. Lengths in mm. */
const NOISE = /* glsl */ `
varying vec3 vRest;
varying float vHair;
varying vec2 vForm;
uniform vec2 neckFade;
#ifdef SKIN_MAPS
varying vec2 vSkinUv;
varying float vWrinkle;
uniform float mapsShown;
uniform sampler2D albedoMap;
uniform sampler2D reliefMap;
uniform sampler2D ormMap;
uniform sampler2D wrinkleMap;
uniform sampler2D poreMap;
#else
const float mapsShown = 0.0;
#endif

/** How many times a texture must be halved for texels as large as pixels, by how texels change across and down. */
float textureLevel(vec2 across, vec2 down) {
  return 0.5 * log2(max(max(dot(across, across), dot(down, down)), 1e-12));
}
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
/** A unit vector from the x and y of a map of normals. */
vec3 unpacked(vec2 packed) {
  vec2 flat2 = packed * 2.0 - 1.0;
  return vec3(flat2, sqrt(max(0.0, 1.0 - dot(flat2, flat2))));
}
float pores(vec3 p) { return noise(p * 1.1) * 0.55 + noise(p * 2.3) * 0.45; }
float stubble(vec3 p) { return noise(p * vec3(2.3, 1.1, 1.1)) * 0.6 + noise(p * vec3(4.1, 2.1, 2.1) + 40.0) * 0.4; }
`;

/**
 * Without maps, from the vertex colours: the redder, the wetter, since lips, the rims and insides of the lids and the
 * mouth are mucosa, and their paint says so. Skin is drier, and neither its tone nor its oil is even.
 */
const PAINTED = /* glsl */ `
float hairCover = 0.0;
float mucosa = 0.0;
float oil = 0.5;
if (mapsShown < 1.0) {
  float redness = diffuseColor.r / max(diffuseColor.g, 1e-3);
  float lip = smoothstep(2.5, 3.3, redness) * (1.0 - vHair);
  mucosa = smoothstep(4.5, 8.0, redness) * (1.0 - vHair);
  oil = pores(vRest * 0.5 + 50.0);
  float blotch = noise(vRest * 0.13 + 30.0) - 0.5;
  float freckle = noise(vRest * 0.62 + 90.0) - 0.5;
  diffuseColor.rgb *= 1.0 + (1.0 - mucosa) * (0.10 * freckle * vec3(0.6, 1.0, 1.15) + 0.09 * blotch * vec3(0.3, 1.0, 0.9));
  roughnessFactor += (oil - 0.5) * 0.22;
  roughnessFactor = mix(roughnessFactor, 0.36, 0.8 * lip * (1.0 - mucosa));
  if (vHair > 0.01) {
    float strand = stubble(vRest + 60.0);
    // Single hairs where they are few, a shade over all of the scalp where they are many.
    float grown = smoothstep(0.05, 0.95, vHair);
    hairCover = grown * mix(smoothstep(0.25, 0.75, strand), 1.0, grown);
    diffuseColor.rgb *= mix(1.0, 0.6 + 0.8 * strand, hairCover);
    roughnessFactor = mix(roughnessFactor, 0.9, hairCover);
  }
}
skinOpen = 1.0 - 0.75 * mucosa;
#ifdef SKIN_MAPS
  vec3 orm = texture2D(ormMap, vSkinUv).rgb;
  vec3 relief = texture2D(reliefMap, vSkinUv).xyz * 2.0 - 1.0;
  vec3 furrows = texture2D(wrinkleMap, vSkinUv).xyz;
  relief = mix(relief, unpacked(furrows.xy), vWrinkle);
  // A wrinkle's floor sees less of the room than the skin around; its walls and rolls are shaded by their slant alone.
  float depth = vWrinkle * (1.0 - furrows.z);
  skinOpen = mix(skinOpen, orm.r * (1.0 - 0.55 * depth), mapsShown);
  diffuseColor.rgb = mix(diffuseColor.rgb, texture2D(albedoMap, vSkinUv).rgb, mapsShown);
  diffuseColor.rgb *= 1.0 - mapsShown * depth * FURROW;
  roughnessFactor = mix(roughnessFactor, orm.g, mapsShown);
  // Under hair the scalp lies in its shadow: it neither shines nor lets light through.
  hairCover = max(hairCover, mapsShown * smoothstep(0.12, 0.5, vHair));
#endif
skinBare = 1.0 - hairCover;
skinBend = vForm.x;
skinThin = vForm.y * (1.0 - hairCover);
// The neck leaves the picture as a vignetted portrait does: as it is lit, evenly into the background.
float intoLight = saturate((vRest.y - neckFade.x) / (neckFade.y - neckFade.x));
diffuseColor.a *= smoothstep(0.04, 0.96, intoLight);
`;

/** Pores without maps, by noise; with maps, the maps' relief and a tile of what is finer than they are. */
const RELIEF = /* glsl */ `
skinSmooth = normal;
skinFolded = normal;
if (mapsShown < 1.0) {
  vec3 at = vRest + 200.0;
  const float STEP = 0.25;
  float here = pores(at);
  vec3 slope = vec3(pores(at + vec3(STEP, 0, 0)), pores(at + vec3(0, STEP, 0)), pores(at + vec3(0, 0, STEP)));
  slope = (viewMatrix * vec4((slope - here) / STEP, 0.0)).xyz;
  slope -= normal * dot(normal, slope);
  normal = normalize(normal - (1.0 - mapsShown) * slope * mix(0.05 * (1.0 - mucosa), 0.10, hairCover));
}
#ifdef SKIN_MAPS
{
  // The frame of the texture coordinates, from how they change across the picture (Mikkelsen's surface gradients).
  vec3 across = dFdx(-vViewPosition);
  vec3 down = dFdy(-vViewPosition);
  vec2 uvAcross = dFdx(vSkinUv);
  vec2 uvDown = dFdy(vSkinUv);
  // Ears and neck have fewer texels a millimetre than the face, and take the tile as often again; the scalp none.
  float stretch = sqrt((dot(across, across) + dot(down, down)) / max(dot(uvAcross, uvAcross) + dot(uvDown, uvDown), 1e-12));
  float tiles = stretch > 0.53 ? 2.0 * PORE_TILES : PORE_TILES;
  vec2 fine = texture2D(poreMap, vSkinUv * tiles).xy * 2.0 - 1.0;
  // Wet skin, as of the lips, has no pores.
  float pored = PORE_DEPTH * smoothstep(0.3, 0.5, orm.g) * smoothstep(1.15, 0.95, stretch);
  vec2 tilt = relief.xy / max(relief.z, 0.2) + pored * fine * vec2(1.0, -1.0);
  vec3 downPerp = cross(down, skinSmooth);
  vec3 acrossPerp = cross(skinSmooth, across);
  vec3 tangent = downPerp * uvAcross.x + acrossPerp * uvDown.x;
  vec3 bitangent = downPerp * uvAcross.y + acrossPerp * uvDown.y;
  float longest = max(dot(tangent, tangent), dot(bitangent, bitangent));
  float scale = longest == 0.0 ? 0.0 : inversesqrt(longest) * mapsShown;
  // Folds shade the skin in every colour alike; only what is finer is blurred by light that travels under it.
  float texels = float(textureSize(wrinkleMap, 0).x);
  float level = max(log2(texels * FOLD_BLUR * 0.001 / max(stretch, 1e-4)), textureLevel(texels * uvAcross, texels * uvDown));
  vec3 fold = unpacked(textureLod(wrinkleMap, vSkinUv, level).xy);
  vec2 bent = vWrinkle * fold.xy / max(fold.z, 0.2);
  skinFolded = normalize(skinSmooth + scale * (tangent * bent.x - bitangent * bent.y));
  // A map's green points up, its rows count down.
  normal = normalize(normal + scale * (tangent * tilt.x - bitangent * tilt.y));
}
#endif
`;

/** Hair is no sheet of skin, and the mouth mirrors no studio: little highlight of their own. */
const GLOSS = /* glsl */ `
float gloss = mix(0.6 + 0.8 * oil, 1.0, mapsShown) * (1.0 - 0.92 * hairCover) * (1.0 - 0.8 * mucosa);
material.specularColor *= gloss;
material.specularColorBlended *= gloss;
material.specularF90 *= gloss;
`;

/** How often the tile of pores lies side by side on the map, and how steep its slopes are. */
const TILES = '#define PORE_TILES 26.0\n#define PORE_DEPTH 0.6\n';

/** What a furrow's floor keeps back of each colour, hardly more of blue; and what is finer than a fold [mm]. */
const FOLDS = '#define FURROW vec3(0.26, 0.30, 0.31)\n#define FOLD_BLUR 0.9\n';

/** An open mouth draws its walls across the teeth, which no tissue holds off: what lies in it is drawn before them. */
const BEHIND_TEETH = /* glsl */ `
if (mouthWall > 0.0) {
  vec4 behind = projectionMatrix * (mvPosition - vec4(0.0, 0.0, 0.03 * mouthWall, 0.0));
  gl_Position.z = behind.z / behind.w * gl_Position.w;
}
`;

/** Where skin is peeled from a face its mouth keeps its walls, or one would see through the head. */
const PEELED = /* glsl */ `
#include <clipping_planes_fragment>
if (vWall < 0.9) {
  diffuseColor.a *= leftOfPeel();
  if (diffuseColor.a <= 0.0) discard;
}
`;

/**
 * Change the program of a physical material into skin. Needs attributes `restPosition` [m], `_hair`, `mouthWall`, `skinForm`
 * of skin-form.ts, where it is peeled `peeling` of peel.ts, and with the define SKIN_MAPS `uv` and `wrinkle`.
 * @throws Error when three's shader no longer has a line that is replaced here.
 */
export function makeSkin(program: Program, uniforms: SkinUniforms): void {
  Object.assign(program.uniforms, uniforms);
  program.vertexShader = replaced(program.vertexShader, [
    [
      '#include <common>',
      `#include <common>
attribute vec3 restPosition;
attribute float _hair;
attribute vec2 skinForm;
attribute float mouthWall;${PEEL_VERTEX}
varying vec3 vRest;
varying float vHair;
varying vec2 vForm;
varying float vWall;
#ifdef SKIN_MAPS
attribute float wrinkle;
varying vec2 vSkinUv;
varying float vWrinkle;
#endif`,
    ],
    [
      '#include <begin_vertex>',
      `#include <begin_vertex>
vRest = restPosition * 1000.0;
vHair = _hair;
vForm = skinForm;
vWall = mouthWall;
vPeeling = peeling;
#ifdef SKIN_MAPS
vSkinUv = uv;
vWrinkle = wrinkle;
#endif`,
    ],
    ['#include <project_vertex>', `#include <project_vertex>\n${BEHIND_TEETH}`],
  ]);
  program.fragmentShader = replaced(program.fragmentShader, [
    [
      '#include <common>',
      `${TILES}${FOLDS}#include <common>\nvarying float vWall;\n${PEEL_FRAGMENT}\n${NOISE}`,
    ],
    ['#include <clipping_planes_fragment>', PEELED],
    ['#include <roughnessmap_fragment>', `#include <roughnessmap_fragment>\n${PAINTED}`],
    ['#include <normal_fragment_maps>', `#include <normal_fragment_maps>\n${RELIEF}`],
    ['#include <lights_physical_fragment>', `#include <lights_physical_fragment>\n${GLOSS}`],
    [
      '#include <lights_physical_pars_fragment>',
      `#include <lights_physical_pars_fragment>\n${SKIN_LIGHT}`,
    ],
    ['#include <lights_fragment_begin>', scatteringShadows()],
    ['#include <lights_fragment_maps>', scatteringSurroundings()],
    ['#include <aomap_fragment>', SKIN_OPENNESS],
    ['#include <shadowmap_pars_fragment>', softerShadows()],
  ]);
}
