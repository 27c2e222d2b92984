// The inner side of the skin that is left where a face is peeled: the dark behind nostrils, lids and the mouth's corners.

import type { BufferGeometry } from 'three';
import { BackSide, Mesh, ShaderMaterial } from 'three';
import { PEEL_FRAGMENT, PEEL_VERTEX } from '../peel';

export interface Hollow {
  skin: Mesh<BufferGeometry>;
  /** What lies further to the left is peeled off [m]. */
  peelCut: { value: number };
  /** Heights between which the neck fades into the ground [mm]; null where there is no cut to hide. */
  neckFade: readonly [number, number] | null;
}

/** To be added to the skin, whose geometry it shares, and shown where that is peeled: only its material is its own. */
export function createHollow({
  skin,
  peelCut,
  neckFade,
}: Hollow): Mesh<BufferGeometry, ShaderMaterial> {
  const material = new ShaderMaterial({
    uniforms: { peelCut, lowest: { value: (neckFade?.[1] ?? -2000) / 1000 } },
    side: BackSide,
    vertexShader: /* glsl */ `
      attribute vec3 restPosition;
      attribute float mouthWall;
      ${PEEL_VERTEX}
      varying float vHeight;
      varying float vWall;
      void main() {
        vPeeling = peeling;
        vHeight = restPosition.y;
        vWall = mouthWall;
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
      }`,
    fragmentShader: /* glsl */ `
      ${PEEL_FRAGMENT}
      uniform float lowest;
      varying float vHeight;
      varying float vWall;
      void main() {
        // Not the walls of the mouth, whose inner side lies outside of it.
        if (vWall > 0.0 || vHeight < lowest || leftOfPeel() < 0.5) discard;
        gl_FragColor = vec4(0.035, 0.012, 0.01, 1.0);
        #include <colorspace_fragment>
      }`,
  });
  const mesh = new Mesh(skin.geometry, material);
  mesh.frustumCulled = false;
  mesh.visible = false;
  return mesh;
}
