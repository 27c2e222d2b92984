// What a sketch is drawn with: matt surfaces under the studio's lamps, by a program so small that it is compiled at once.

import type { Color, Texture } from 'three';
import { DoubleSide, ShaderMaterial, UniformsLib, UniformsUtils } from 'three';
import { PEEL_FRAGMENT, PEEL_VERTEX } from './peel';

/** Less of a card's picture than this is no hair. */
const CUT = '0.35';

export interface SketchLook {
  vertexColors: boolean;
  /** Factor on what the surface reflects. */
  color: Color;
  /** Picture of hair that cards are cut out of. */
  map: Texture | null;
  /** What of the skin lies further to the left is peeled off [m]. */
  peelCut: { value: number };
}

/** Lambert's law as three has it, without all that a sketch does not need: its own program is ten times as long. */
export function sketchMaterial({ vertexColors, color, map, peelCut }: SketchLook): ShaderMaterial {
  const material = new ShaderMaterial({
    // All surfaces alike, so that two programs draw all of a face.
    side: DoubleSide,
    lights: true,
    vertexColors,
    defines: map === null ? {} : { CARDS: '' },
    uniforms: UniformsUtils.merge([UniformsLib.lights, { gain: { value: color } }]),
    vertexShader: /* glsl */ `
      #include <color_pars_vertex>
      ${PEEL_VERTEX}
      varying vec3 vFacing;
      varying vec2 vPicture;
      void main() {
        #include <color_vertex>
        vFacing = normalMatrix * normal;
        vPicture = uv;
        vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
        gl_Position = projectionMatrix * mvPosition;
        vPeeling = peeling;
      }`,
    fragmentShader: /* glsl */ `
      #include <color_pars_fragment>
      ${PEEL_FRAGMENT}
      struct DirectionalLight { vec3 direction; vec3 color; };
      struct HemisphereLight { vec3 direction; vec3 skyColor; vec3 groundColor; };
      uniform DirectionalLight directionalLights[NUM_DIR_LIGHTS];
      uniform HemisphereLight hemisphereLights[NUM_HEMI_LIGHTS];
      uniform vec3 gain;
      uniform sampler2D picture;
      varying vec3 vFacing;
      varying vec2 vPicture;
      void main() {
        // What is no skin has no place in what is peeled: noughts.
        if (leftOfPeel() < 0.5) discard;
        vec4 diffuseColor = vec4(gain, 1.0);
        #ifdef CARDS
          diffuseColor *= texture2D(picture, vPicture);
          if (diffuseColor.a < ${CUT}) discard;
        #endif
        #include <color_fragment>
        // Both sides are lit as the outer one is: strands are round, and edges of skin no dark lines.
        vec3 normal = normalize(vFacing);
        HemisphereLight sky = hemisphereLights[0];
        vec3 light = mix(sky.groundColor, sky.skyColor, 0.5 * dot(normal, sky.direction) + 0.5);
        for (int lamp = 0; lamp < NUM_DIR_LIGHTS; lamp++) {
          light += max(dot(normal, directionalLights[lamp].direction), 0.0) * directionalLights[lamp].color;
        }
        gl_FragColor = vec4(diffuseColor.rgb * light / 3.14159265, 1.0);
        #include <tonemapping_fragment>
        #include <colorspace_fragment>
      }`,
  });
  // Not merged with the others: that would copy the picture, and upload it twice.
  material.uniforms.picture = { value: map };
  material.uniforms.peelCut = peelCut;
  return material;
}
