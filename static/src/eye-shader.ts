// What eyes add to three's physical shader: an iris seen through its cornea, and the shade of the lids.

import type { Texture } from 'three';
import { Matrix3, Vector3, Vector4 } from 'three';
import type { Program } from './shader-edit';
import { replaced } from './shader-edit';
import { softenShadows } from './soft-shadows';

/** What an eye's shaders must know of it from frame to frame; lengths in mm, from the ball's middle. */
export class EyeSetting {
  /** How the eye is turned in the head. */
  readonly turn = { value: new Matrix3() };
  /** Inner and outer corner of the lids, head frame: x, y, x, y. */
  readonly corners = { value: new Vector4(-15, -0.5, 15, 1) };
  /** Height of the middles of upper and lower lid, and the side (1 left, -1 right). */
  readonly lids = { value: new Vector3(5, -5.3, 1) };

  constructor(
    side: number,
    readonly map: { value: Texture | null },
  ) {
    this.lids.value.z = side;
  }

  get uniforms(): Record<string, { value: unknown }> {
    return {
      eyeTurn: this.turn,
      lidCorners: this.corners,
      lidMiddles: this.lids,
      eyeMap: this.map,
    };
  }
}

const VERTEX: readonly (readonly [string, string])[] = [
  [
    '#include <common>',
    `#include <common>
varying vec3 vInEye;
varying vec3 vInEyeNormal;
varying vec3 vEyeCamera;`,
  ],
  [
    '#include <begin_vertex>',
    `#include <begin_vertex>
vInEye = position * 1000.0;
vInEyeNormal = normal;
vEyeCamera = (inverse(modelMatrix) * vec4(cameraPosition, 1.0)).xyz * 1000.0;`,
  ],
];

/** Lids shade the ball that they nearly touch: more the upper one, which overhangs it with its lashes. */
const COMMON = /* glsl */ `
varying vec3 vInEye;
varying vec3 vInEyeNormal;
varying vec3 vEyeCamera;
uniform mat3 eyeTurn;
uniform vec4 lidCorners;
uniform vec3 lidMiddles;
uniform sampler2D eyeMap;
float eyeMapped() { return textureSize(eyeMap, 0).x > 1 ? 1.0 : 0.0; }
vec2 eyeUv(vec2 across, float offAxis) {
  float radius = 0.5 * pow(clamp(offAxis / 1.5707963, 0.0, 1.0), 0.75);
  vec2 turned = across / max(length(across), 1e-5) * radius;
  return vec2(0.5 + lidMiddles.z * turned.x, 0.5 - turned.y);
}
vec3 lidShade(vec3 inEye) {
  vec3 p = eyeTurn * inEye;
  float s = clamp((p.x - lidCorners.x) / (lidCorners.z - lidCorners.x), 0.0, 1.0);
  float bow = pow(max(4.0 * s * (1.0 - s), 0.0), 0.8);
  float corner = mix(lidCorners.y, lidCorners.w, s);
  float under = mix(corner, lidMiddles.x, bow) - p.y;
  float over = p.y - mix(corner, lidMiddles.y, bow);
  float shade = mix(0.07, 1.0, smoothstep(-0.7, 2.9, under)) * mix(0.5, 1.0, smoothstep(0.3, 7.5, under));
  shade *= mix(0.42, 1.0, smoothstep(-0.6, 2.4, over));
  shade *= mix(0.36, 1.0, smoothstep(-0.02, 0.32, s) * smoothstep(1.02, 0.62, s));
  // What light comes back from the lids is red.
  return pow(vec3(shade), vec3(0.82, 1.04, 1.1));
}
`;

const SCLERA = /* glsl */ `
#include <color_fragment>
{
  float offAxis = acos(clamp(normalize(vInEye).z, -1.0, 1.0));
  vec3 mapped = texture2D(eyeMap, eyeUv(vInEye.xy, offAxis)).rgb;
  diffuseColor.rgb = mix(diffuseColor.rgb, mapped, eyeMapped());
  diffuseColor.rgb *= lidShade(vInEye);
}
`;

/** The lamps' own points would be sparks beside the boxes that the ball mirrors. */
const SOFT_SPARKS = /* glsl */ `
#include <lights_fragment_end>
clearcoatSpecularDirect *= 0.3;
clearcoatSpecularIndirect *= lidShade(vInEye).g;
`;

/** Light wanders in the sclera, so that it has no sharp terminator: a flatter ball looks like that. */
const SOFT_BALL = /* glsl */ `
#include <normal_fragment_maps>
normal = normalize(mix(normal, normalize(normalMatrix * (transpose(eyeTurn) * vec3(0.0, 0.0, 1.0))), 0.2));
`;

/**
 * Change the program of a physical material into an eyeball.
 * @throws Error when three's shader no longer has a line that is replaced here.
 */
export function makeEyeball(program: Program, setting: EyeSetting): void {
  Object.assign(program.uniforms, setting.uniforms);
  program.vertexShader = replaced(program.vertexShader, VERTEX);
  program.fragmentShader = replaced(program.fragmentShader, [
    ['#include <common>', `#include <common>\nuniform mat3 normalMatrix;\n${COMMON}`],
    ['#include <color_fragment>', SCLERA],
    ['#include <normal_fragment_maps>', SOFT_BALL],
    ['#include <lights_fragment_end>', SOFT_SPARKS],
  ]);
  softenShadows(program);
}

/**
 * The ray from the camera bends at the cornea (n of the aqueous humour) and meets the iris behind it. Sizes are
 * those of engine/head/parts/eyes.py.
 */
const IRIS = /* glsl */ `
#include <color_fragment>
vec3 irisNormal;
float irisCover;
{
  const float IRIS_DEPTH = 9.95;
  const float IRIS_RADIUS = 5.85;
  vec3 ray = refract(normalize(vInEye - vEyeCamera), normalize(vInEyeNormal), 1.0 / 1.336);
  float way = (IRIS_DEPTH - vInEye.z) / min(ray.z, -0.05);
  vec2 hit = vInEye.xy + ray.xy * way;
  float r = length(hit);
  float inside = min(r, 5.45);
  vec2 at = hit / max(r, 1e-4) * inside;
  vec2 uv = eyeUv(at, asin(inside / 12.0));
  vec3 iris = texture2D(eyeMap, uv).rgb;
  // Fibres stand up: the slope of their light tilts the iris's surface.
  const float STEP = 1.5 / 512.0;
  vec3 weigh = vec3(0.4, 0.5, 0.1);
  vec2 slope = vec2(
    dot(texture2D(eyeMap, uv + vec2(STEP, 0.0)).rgb - texture2D(eyeMap, uv - vec2(STEP, 0.0)).rgb, weigh),
    dot(texture2D(eyeMap, uv - vec2(0.0, STEP)).rgb - texture2D(eyeMap, uv + vec2(0.0, STEP)).rgb, weigh));
  slope.x *= lidMiddles.z;
  slope /= 0.06 + dot(iris, weigh);
  float outside = smoothstep(1.75, 2.1, inside);
  // A dish: the side away from the light catches what the cornea gathers.
  irisNormal = normalize(vec3(-at / IRIS_RADIUS * 0.8 - 0.10 * outside * slope, 1.0));
  iris *= 1.0 - 0.75 * smoothstep(5.0, 6.3, r);
  irisCover = eyeMapped() * (1.0 - smoothstep(5.2, 6.25, length(vInEye.xy)));
  diffuseColor.rgb = 0.78 * iris * lidShade(vInEye);
}
`;

const IRIS_NORMAL = /* glsl */ `
#include <normal_fragment_maps>
normal = normalize(normalMatrix * irisNormal);
`;

/** The iris covers what is drawn behind; the highlights of the cornea add to either. */
const COVER = /* glsl */ `
gl_FragColor = vec4(outgoingLight - totalDiffuse * (1.0 - irisCover), irisCover);
`;

/** Less is mirrored near the upper lid, which the surroundings' map knows nothing of. */
const HIGHLIGHT = /* glsl */ `
#include <lights_fragment_end>
{
  float open = lidShade(vInEye).g;
  // The key's box is what a photographer calls the catch light; the lamp's own point would double it.
  float lit = dot(clearcoatSpecularIndirect, vec3(0.33));
  clearcoatSpecularIndirect *= open * open * mix(0.7, 3.5, smoothstep(0.05, 0.13, lit));
  clearcoatSpecularDirect *= 0.2 * smoothstep(0.25, 0.6, open);
}
`;

/**
 * Change the program of a physical material with a clear coat into a cornea with its iris behind.
 * Its material blends premultiplied colours.
 * @throws Error when three's shader no longer has a line that is replaced here.
 */
export function makeCornea(program: Program, setting: EyeSetting): void {
  Object.assign(program.uniforms, setting.uniforms);
  program.vertexShader = replaced(program.vertexShader, VERTEX);
  program.fragmentShader = replaced(program.fragmentShader, [
    ['#include <common>', `#include <common>\nuniform mat3 normalMatrix;\n${COMMON}`],
    ['#include <color_fragment>', IRIS],
    ['#include <normal_fragment_maps>', IRIS_NORMAL],
    ['#include <lights_fragment_end>', HIGHLIGHT],
    ['#include <opaque_fragment>', COVER],
    ['#include <premultiplied_alpha_fragment>', ''],
  ]);
  softenShadows(program);
}
