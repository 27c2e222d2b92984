// What hair adds to three's standard shader: the two highlights along its strands, light that shines through,
// strands that are never thinner than a pixel, and where cards are solid and where thin.

import { ShaderChunk } from 'three';
import type { Program } from './shader-edit';
import { replaced } from './shader-edit';

/** Half the least width of a drawn strand, in pixels across half the picture's height. */
const LEAST_PIXELS = '1.15';

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

const SIDES = `
attribute vec4 strandSide;
uniform float drawnHeight;
varying float vCover;`;

const TANGENT = /* glsl */ `
#include <beginnormal_vertex>
vStrand = normalize(mat3(modelViewMatrix) * strandTangent.xyz);
`;

/**
 * Hair that is cropped short stands in all directions, root beside tip: it has no sheen along it, and cards of it that
 * shone by themselves would lie on a dark scalp like flecks. Lengths in metres.
 */
const SHEEN = /* glsl */ `
vSheen = mix(0.2, 1.0, smoothstep(0.004, 0.018, strandTangent.w));
`;

/**
 * Marschner et al. 2003 as Kajiya-Kay lobes: a white one of the surface, shifted to the root, and a broader coloured
 * one of light that was reflected inside, shifted to the tip; and light from behind that comes through.
 */
const LIGHT = /* glsl */ `
varying vec3 vStrand;
float strandShift = 0.0;

float lobe(vec3 tangent, vec3 halfway, float sharpness) {
  float along = dot(tangent, halfway);
  return smoothstep(-1.0, 0.0, along) * pow(max(1.0 - along * along, 0.0), 0.5 * sharpness);
}

void RE_Direct_Hair(const in IncidentLight light, const in vec3 position, const in vec3 faces, const in vec3 view,
    const in vec3 clearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight) {
  vec3 strand = normalize(vStrand);
  vec3 halfway = normalize(light.direction + view);
  float cosine = dot(faces, light.direction);
  float lit = clamp((cosine + 0.3) / 1.3, 0.0, 1.0);
  float facing = smoothstep(-0.25, 0.35, cosine);
  float across = sqrt(max(1.0 - pow(dot(strand, light.direction), 2.0), 0.0));
  vec3 color = material.diffuseContribution;
  float brightness = max(max(color.r, color.g), max(color.b, 1e-4));
  vec3 hue = color / brightness;
  reflectedLight.directDiffuse += light.color * color * lit * (0.35 + 0.65 * across) * RECIPROCAL_PI * 1.15;

  float white = lobe(normalize(strand - (0.12 + strandShift) * faces), halfway, 110.0);
  float tinted = lobe(normalize(strand + (0.10 - strandShift) * faces), halfway, 26.0);
  vec3 gloss = 0.009 * white + (0.16 * brightness + 0.003) * tinted * mix(hue, vec3(1.0), 0.12);
  float behind = pow(clamp(dot(-light.direction, view) * 0.5 + 0.5, 0.0, 1.0), 6.0);
  vec3 through = 0.55 * color * behind * across;
  reflectedLight.directSpecular += light.color * (gloss * facing * vSheen + through);
}
#undef RE_Direct
#define RE_Direct RE_Direct_Hair
`;

/** The roughness of a head of hair is the strands' scatter: its room is a soft glow, no mirror. */
const SCATTER = /* glsl */ `
#include <lights_physical_fragment>
strandShift = 0.16 * (strandTone - 0.78);
material.specularColor *= 0.35;
material.specularColorBlended *= 0.35;
material.specularF90 *= 0.25;
`;

/** Hair that covers more of a pixel than this covers all of it. */
const SOLID = '0.7';

/**
 * Cards seen edge on would draw a hard line. Where hair is solid it is drawn first and hides what is behind it; what is
 * thinner is drawn after it, and blended: see fringe.ts.
 */
const CUT = /* glsl */ `
#ifdef USE_MAP
  vec3 cardFaces = normalize(cross(dFdx(vViewPosition), dFdy(vViewPosition)));
  diffuseColor.a *= smoothstep(0.0, 0.24, abs(dot(cardFaces, normalize(vViewPosition))));
  diffuseColor.a = min(diffuseColor.a * 1.25, 1.0);
  bool solid = diffuseColor.a > ${SOLID};
  if (solid == fringe || diffuseColor.a < 0.02) discard;
  if (solid) diffuseColor.a = 1.0;
#endif
`;

/** What of hair a program draws. */
export interface HairUniforms {
  /** Whether it is drawn on cards, not strand by strand. */
  cards: boolean;
  /** Height of the picture [px]; cards do not ask. */
  drawnHeight: { value: number };
  /** Draw what of cards is thin, not what is solid; strands do not ask. */
  fringe: { value: boolean };
}

/**
 * Change the program of a physical material into hair. Needs the attributes of hair-attributes: `strandTangent`, and
 * `strandSide` for single strands.
 * @throws Error when three's shader no longer has a line that is replaced here.
 */
export function makeHair(program: Program, { cards, drawnHeight, fringe }: HairUniforms): void {
  program.uniforms.drawnHeight = drawnHeight;
  program.uniforms.fringe = fringe;
  const cut: [string, string][] = cards ? [['#include <alphatest_fragment>', CUT]] : [];
  const strandOnly: [string, string][] = cards ? [] : [['#include <project_vertex>', WIDEN]];
  program.vertexShader = replaced(program.vertexShader, [
    [
      '#include <common>',
      `#define LEAST_PIXELS ${LEAST_PIXELS}\n#include <common>\nattribute vec4 strandTangent;\nvarying vec3 vStrand;${cards ? '\nvarying float vSheen;' : SIDES}`,
    ],
    ['#include <beginnormal_vertex>', cards ? TANGENT + SHEEN : TANGENT],
    ...strandOnly,
  ]);
  program.fragmentShader = replaced(program.fragmentShader, [
    [
      '#include <common>',
      `#include <common>\n${cards ? 'uniform bool fringe;\nvarying float vSheen;' : 'varying float vCover;\nconst float vSheen = 1.0;'}\nfloat strandTone = 0.78;`,
    ],
    [
      '#include <map_fragment>',
      '#include <map_fragment>\n#ifdef USE_MAP\nstrandTone = sampledDiffuseColor.r;\n#else\ndiffuseColor.a *= vCover;\n#endif',
    ],
    ...cut,
    ['#include <lights_fragment_maps>', glowOfRoom()],
    ['#include <normal_fragment_begin>', unflippedNormals()],
    [
      '#include <lights_physical_pars_fragment>',
      `#include <lights_physical_pars_fragment>\n${LIGHT}`,
    ],
    ['#include <lights_physical_fragment>', SCATTER],
  ]);
}

/** As rough as hair is, its mirror of the room is as soft as its shade: one look at the room does for both. */
function glowOfRoom(): string {
  return replaced(ShaderChunk.lights_fragment_maps, [
    [
      'vec3 iblRadiance = getIBLRadiance( geometryViewDir, geometryNormal, material.roughness );',
      'vec3 iblRadiance = iblIrradiance * RECIPROCAL_PI;',
    ],
  ]);
}

/** Both faces of a ribbon are lit as the skin under it is, or half of all hairs would be black. */
function unflippedNormals(): string {
  return replaced(ShaderChunk.normal_fragment_begin, [['gl_FrontFacing ? 1.0 : - 1.0', '1.0']]);
}
