// How skin takes light: it bleeds under the surface, shines twice, and shines through where it is thin.

import { ShaderChunk } from 'three';
import { replaced } from './shader-edit';

/**
 * Skin's own answer to one light, in place of three's. Per colour, since red travels farthest (about 3.7 mm, green 1.4,
 * blue 0.7: d'Eon and Luebke, GPU Gems 3, ch. 14): the farther, the blurrier the relief it sees, and the farther round
 * a bend it reaches, as in pre-integrated skin shading (Penner, SIGGRAPH 2011).
 */
export const SKIN_LIGHT = /* glsl */ `
/** Set before the lights: relief-free normal, that with broad folds, curvature [1/mm], thinness, openness, share that is skin and not hair. */
vec3 skinSmooth;
vec3 skinFolded;
float skinBend;
float skinThin;
float skinOpen;
float skinBare;

/** Sine of half the angle that a soft box fills: its light fades over so much, and does not end at a line. */
const float BOX = 0.28;
const vec3 BLUR = vec3(0.88, 0.62, 0.42);
const vec3 REACH = vec3(0.055, 0.022, 0.014);
const vec3 REACH_PER_BEND = vec3(2.6, 1.0, 0.55);

vec3 boxedCosine(vec3 cosine) {
  vec3 edge = clamp((cosine + BOX) / (2.0 * BOX), 0.0, 1.0);
  return mix(BOX * edge * edge, cosine, step(vec3(BOX), cosine));
}

vec3 scatteredCosine(vec3 cosine) {
  vec3 reach = skinBare * (REACH + REACH_PER_BEND * clamp(abs(skinBend), 0.0, 0.2));
  vec3 reached = boxedCosine((cosine + reach) / (1.0 + reach));
  return reached / (1.0 + 0.6 * reach * (1.0 - reached));
}

vec3 scatteredShadow(float lit, float cosine) {
  // Beyond the terminator the map only shows the skin shading itself, which the scattered cosine does better.
  float open = mix(lit, 1.0, 0.65 * smoothstep(0.26, -0.14, cosine));
  return pow(vec3(max(open, 0.0)), mix(vec3(1.0), vec3(0.72, 0.96, 1.04), skinBare));
}

void RE_Direct_Skin(
  const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal,
  const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material,
  inout ReflectedLight reflectedLight
) {
  vec3 light = directLight.direction;
  float dotNL = dot(geometryNormal, light);
  vec3 cosines = mix(vec3(dotNL), vec3(dot(skinFolded, light)), BLUR * skinBare);
  // A crease sees little of a light that stands low over it (Chan, SIGGRAPH 2018).
  float crease = saturate(dotNL + 2.0 * skinOpen * skinOpen);
  // A light behind the head reaches its edges alone; what faces the camera it would have to pass the head for, and
  // what lies beside the nose the cheek. It throws no shadow, so that the openness tells edges that stand free.
  float facing = saturate(dot(skinSmooth, geometryViewDir));
  float edge = smoothstep(0.5, -0.04, facing) * smoothstep(0.78, 0.92, skinOpen);
  crease *= mix(1.0, edge, smoothstep(0.0, -0.35, dot(light, geometryViewDir)));
  vec3 irradiance = scatteredCosine(cosines) * directLight.color * crease;

  vec3 halfway = normalize(light + geometryViewDir);
  float dotNV = saturate(dot(geometryNormal, geometryViewDir));
  float dotNH = saturate(dot(geometryNormal, halfway));
  float dotVH = saturate(dot(geometryViewDir, halfway));
  vec3 fresnel = F_Schlick(material.specularColorBlended, material.specularF90, dotVH);
  float broad = pow2(min(1.0, material.roughness * 1.18));
  float tight = pow2(material.roughness * 0.66);
  float lobes = mix(D_GGX(broad, dotNH), D_GGX(tight, dotNH), 0.22);
  float shine = lobes * V_GGX_SmithCorrelated(pow2(material.roughness), saturate(dotNL), dotNV);
  reflectedLight.directSpecular += saturate(dotNL) * directLight.color * crease * fresnel * shine;

  vec3 diffuse = irradiance * BRDF_Lambert(material.diffuseContribution) * (1.0 - fresnel);
  // Down on the cheeks catches light where one looks along it.
  float down = 0.07 * skinBare * pow3(1.0 - dotNV);
  diffuse += down * irradiance * RECIPROCAL_PI * mix(material.diffuseContribution, vec3(0.8, 0.62, 0.5), 0.5);
  // Light from behind comes through red, and most where one looks towards it.
  float towards = pow3(saturate(-dot(geometryViewDir, normalize(light + 0.35 * skinSmooth))));
  float behind = saturate(-dot(skinSmooth, light)) * (0.08 + 0.26 * towards);
  diffuse += skinThin * behind * directLight.color * RECIPROCAL_PI * vec3(0.6, 0.15, 0.07)
    * sqrt(material.diffuseContribution);
  reflectedLight.directDiffuse += diffuse;
}
#undef RE_Direct
#define RE_Direct RE_Direct_Skin

/** Openness as light sees it that bounces about in a fold of its own colour (Jimenez and others, SIGGRAPH 2016). */
vec3 bouncedOpenness(float open, vec3 albedo) {
  vec3 a = 2.0404 * albedo - 0.3324;
  vec3 b = -4.7951 * albedo + 0.6417;
  vec3 c = 2.7552 * albedo + 0.6903;
  return max(vec3(open), ((open * a + b) * open + c) * open);
}
`;

/** Light from all around, dimmed in folds; goes where three would apply an occlusion map. */
export const SKIN_OPENNESS = /* glsl */ `
reflectedLight.indirectDiffuse *= bouncedOpenness(skinOpen, material.diffuseColor);
reflectedLight.indirectSpecular *= computeSpecularOcclusion(
  saturate(dot(geometryNormal, geometryViewDir)), skinOpen * skinOpen, material.roughness);
`;

/** Three's loop over the lights, with shadows that are redder at their edge. */
export function scatteringShadows(): string {
  return ShaderChunk.lights_fragment_begin.replace(
    /directLight\.color \*= \( directLight\.visible && receiveShadow \) \? (getShadow\( directionalShadowMap.*?\)) : 1\.0;/,
    'directLight.color *= scatteredShadow( ( directLight.visible && receiveShadow ) ? $1 : 1.0, dot( skinSmooth, directLight.direction ) );',
  );
}

/** Light from all around comes from far, and scatters: it sees hardly any relief. */
export function scatteringSurroundings(): string {
  return replaced(ShaderChunk.lights_fragment_maps, [
    [
      'getIBLIrradiance( geometryNormal )',
      'getIBLIrradiance( normalize( mix( geometryNormal, skinSmooth, 0.65 * skinBare ) ) )',
    ],
  ]);
}
