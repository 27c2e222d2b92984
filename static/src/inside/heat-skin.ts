// The skin as a map of amounts: in place of its own colours those of the ramp, a little shaded so that form is seen.

import type { Material, Mesh } from 'three';
import {
  DataTexture,
  Float32BufferAttribute,
  LinearFilter,
  ShaderMaterial,
  SRGBColorSpace,
  Vector2,
} from 'three';
import { PEEL_FRAGMENT, PEEL_VERTEX } from '../peel';
import { rampTexels } from './ramp';

/** Who has a skin that can be drawn with another material; `paint` returns the one that it had. */
export interface Painted {
  readonly skin: Mesh;
  /** Heights between which the neck fades into the ground [mm]; null where there is no cut to hide. */
  readonly neckFade: readonly [number, number] | null;
  /** What lies further to the left is peeled off [m]. */
  readonly peelCut: { value: number };
  paint(material: Material | Material[]): Material | Material[];
}

const TEXELS = 256;
/** A fade that never begins [mm]. */
const NO_FADE = [-2000, -1999] as const;

export class HeatSkin {
  private readonly material: ShaderMaterial;
  private readonly own: Material | Material[];

  /** @param face its skin is drawn as a map until this is disposed of. */
  constructor(private readonly face: Painted) {
    this.material = createMap(face);
    const { geometry } = face.skin;
    const count = geometry.getAttribute('position').count;
    geometry.setAttribute('heat', new Float32BufferAttribute(new Float32Array(count), 1));
    this.own = face.paint(this.material);
  }

  /** Amounts at the drawn vertices, as shares of the most that the ramp shows. */
  show(amounts: ArrayLike<number>, most: number): void {
    const heat = this.face.skin.geometry.getAttribute('heat');
    for (let at = 0; at < heat.count; at++) heat.setX(at, amounts[at]! / most);
    heat.needsUpdate = true;
  }

  dispose(): void {
    this.face.paint(this.own);
    this.face.skin.geometry.deleteAttribute('heat');
    (this.material.uniforms.ramp!.value as DataTexture).dispose();
    this.material.dispose();
  }
}

function createMap({ neckFade, peelCut }: Painted): ShaderMaterial {
  const ramp = new DataTexture(rampTexels(TEXELS), TEXELS, 1);
  ramp.colorSpace = SRGBColorSpace;
  ramp.magFilter = ramp.minFilter = LinearFilter;
  ramp.needsUpdate = true;
  return new ShaderMaterial({
    uniforms: {
      peelCut,
      ramp: { value: ramp },
      neckFade: { value: new Vector2(...(neckFade ?? NO_FADE)) },
    },
    transparent: neckFade !== null,
    vertexShader: /* glsl */ `
      attribute float heat;
      attribute vec3 restPosition;
      varying float vHeat;
      varying float vHeight;
      varying vec3 vNormal;
      ${PEEL_VERTEX}
      void main() {
        vHeat = heat;
        vHeight = 1000.0 * restPosition.y;
        vNormal = normalize(normalMatrix * normal);
        vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
        gl_Position = projectionMatrix * mvPosition;
        vPeeling = peeling;
      }`,
    fragmentShader: /* glsl */ `
      uniform sampler2D ramp;
      uniform vec2 neckFade;
      varying float vHeat;
      varying float vHeight;
      varying vec3 vNormal;
      ${PEEL_FRAGMENT}
      void main() {
        float left = leftOfPeel();
        if (left <= 0.0) discard;
        vec3 color = texture2D(ramp, vec2(clamp(vHeat, 0.0, 1.0), 0.5)).rgb;
        float light = max(0.0, dot(normalize(vNormal), normalize(vec3(-0.3, 0.45, 0.85))));
        // Dark colours get a little of the light as such, or form would be lost where nothing is strained.
        gl_FragColor = vec4(color * (0.62 + 0.5 * light) + 0.035 * light, left * smoothstep(neckFade.x, neckFade.y, vHeight));
        #include <colorspace_fragment>
      }`,
  });
}
