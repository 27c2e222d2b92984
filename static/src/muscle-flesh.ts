// What the drawn muscles are made of: dark when slack, glowing when they contract, blue when in hand.

import { ShaderMaterial } from 'three';

/** Material of the fibres; `inHand` is the number of the one that stands out. */
export function createFlesh(): ShaderMaterial {
  return new ShaderMaterial({
    transparent: true,
    uniforms: { inHand: { value: -1 } },
    vertexShader: /* glsl */ `
      attribute float activation;
      attribute float muscle;
      uniform float inHand;
      varying float vActivation;
      varying float vHeld;
      varying vec3 vNormal;
      varying float vFacing;
      varying vec3 vPlace;
      void main() {
        vActivation = activation;
        vHeld = 1.0 - step(0.5, abs(muscle - inHand));
        vPlace = position;
        vNormal = normalize(normalMatrix * normal);
        vec4 seen = modelViewMatrix * vec4(position, 1.0);
        // What lies on the far side of the head is not seen through it.
        vec3 out3 = normalize(normalMatrix * normalize(vec3(position.x, 0.0, position.z)));
        vFacing = dot(out3, normalize(-seen.xyz));
        gl_Position = projectionMatrix * seen;
        // The one in hand is hidden by none of the others, and still by itself.
        if (vHeld > 0.5) gl_Position.z = 0.01 * gl_Position.z - 0.98 * gl_Position.w;
      }`,
    fragmentShader: /* glsl */ `
      uniform float inHand;
      varying float vActivation;
      varying float vHeld;
      varying vec3 vNormal;
      varying float vFacing;
      varying vec3 vPlace;
      void main() {
        float power = clamp(vActivation, 0.0, 1.2);
        vec3 slack = vec3(0.30, 0.065, 0.05);
        vec3 tight = vec3(1.0, 0.27, 0.06);
        vec3 hot = vec3(1.0, 0.72, 0.32);
        vec3 color = mix(slack, tight, smoothstep(0.0, 0.6, power));
        color = mix(color, hot, smoothstep(0.5, 1.1, power));
        // Blue on skin is told apart by every eye; a dark edge holds it on bright skin.
        float edge = smoothstep(0.35, 0.95, 1.0 - abs(normalize(vNormal).z));
        vec3 held = mix(mix(vec3(0.30, 0.72, 1.0), vec3(0.01, 0.07, 0.16), edge), color, 0.75 * smoothstep(0.05, 0.6, power));
        color = mix(color, held, vHeld);
        float light = 0.38 + 0.62 * max(0.0, dot(normalize(vNormal), normalize(vec3(-0.35, 0.5, 0.8))));
        color *= mix(light, 1.0, max(0.6 * min(1.0, power), 0.5 * vHeld));
        float rest = vHeld > 0.5 ? 0.96 : inHand < 0.0 ? 0.62 : 0.34;
        float seen = smoothstep(0.0, 0.3, vFacing) * mix(rest, 0.98, min(1.0, power * 1.6));
        if (seen < 0.01) discard;
        gl_FragColor = vec4(color, seen);
        #include <colorspace_fragment>
      }`,
  });
}
