// The studio: key, fill and rim lights with a soft shadow, and the soft boxes that skin and eyes mirror.

import type { Texture, WebGLRenderer } from 'three';
import {
  Color,
  DirectionalLight,
  DoubleSide,
  Group,
  HemisphereLight,
  Mesh,
  MeshBasicMaterial,
  PlaneGeometry,
  PMREMGenerator,
  Scene,
  ShaderMaterial,
} from 'three';

const SHADOW_MAP_SIZE = 1024;

/** Lights for a camera in front of the face; turn the group with the camera, so that every view is well lit. */
export function createLights(): Group {
  const lights = new Group();
  const key = new DirectionalLight(0xfff4ea, 2.8);
  key.position.set(-0.215, 0.25, 0.35);
  castSoftShadow(key);
  const fill = new DirectionalLight(0xe6ebf7, 0.36);
  fill.position.set(0.36, 0.02, 0.3);
  // From so far behind, these touch only edges, and no shadow of theirs is missed.
  const rimLeft = new DirectionalLight(0xeef2fa, 0.9);
  rimLeft.position.set(0.26, 0.16, -0.36);
  const rimRight = new DirectionalLight(0xffecd8, 0.7);
  rimRight.position.set(-0.28, 0.12, -0.36);
  lights.add(
    key,
    key.target,
    fill,
    rimLeft,
    rimRight,
    new HemisphereLight(0xeceef4, 0x8a6a5a, 0.1),
  );
  return lights;
}

function castSoftShadow(light: DirectionalLight): void {
  light.castShadow = true;
  light.shadow.mapSize.set(SHADOW_MAP_SIZE, SHADOW_MAP_SIZE);
  // A soft box as near as a portrait's: what stands off by 2 cm throws an edge of about 8 mm.
  light.shadow.radius = 12;
  // Some of the key's light comes back from the room, also where it does not reach.
  light.shadow.intensity = 0.8;
  light.shadow.bias = -0.0008;
  light.shadow.normalBias = 0.0014;
  const camera = light.shadow.camera;
  [camera.left, camera.right, camera.top, camera.bottom] = [-0.17, 0.17, 0.17, -0.21];
  [camera.near, camera.far] = [0.1, 0.9];
}

/** What glossy surfaces mirror: a dim room, the key's box, a strip at the other side, a ceiling, boxes behind. */
export function createEnvironment(renderer: WebGLRenderer): Texture {
  const room = new Scene();
  room.background = new Color(0x2a2b2e);
  room.add(
    softBox([-4, 3.8, 5], [3.2, 3.6], 12),
    softBox([5.4, 0.4, 3.6], [1.6, 5], 3.4),
    softBox([0, 7, 0.5], [6, 4], 3.2),
    softBox([0, -6, 3], [7, 3], 0.9),
    softBox([5, 2, -5], [2.2, 5], 5),
    softBox([-5.4, 2, -5], [1.8, 5], 3.2),
  );
  const generator = new PMREMGenerator(renderer);
  const environment = generator.fromScene(room, 0.01).texture;
  generator.dispose();
  return environment;
}

function softBox(
  position: [number, number, number],
  size: [number, number],
  radiance: number,
): Mesh {
  const box = new Mesh(
    new PlaneGeometry(...size),
    new MeshBasicMaterial({ color: new Color(radiance, radiance, radiance), side: DoubleSide }),
  );
  box.position.set(...position);
  box.lookAt(0, 0, 0);
  return box;
}

/** What may stand behind the face: on a page of its own the dark one, in documents also the light one. */
export const GROUNDS = {
  dark: { centre: '#4a4d50', edge: '#17191c' },
  light: { centre: '#ffffff', edge: '#dcd9d4' },
} as const;
export type Ground = keyof typeof GROUNDS;
export type Backdrop = Mesh<PlaneGeometry, ShaderMaterial>;

/** Put another ground behind the face. */
export function setGround(backdrop: Backdrop, ground: Ground): void {
  const { uniforms } = backdrop.material;
  for (const end of ['centre', 'edge'] as const) {
    (uniforms[end]!.value as Color).set(GROUNDS[ground][end]);
  }
}

/** A quiet backdrop, lighter behind the head; dithered, since dark gradients band in 8 bits. */
export function createBackdrop(): Backdrop {
  const material = new ShaderMaterial({
    depthTest: false,
    depthWrite: false,
    uniforms: {
      centre: { value: new Color(GROUNDS.dark.centre) },
      edge: { value: new Color(GROUNDS.dark.edge) },
    },
    vertexShader: /* glsl */ `
      varying vec2 vScreen;
      void main() {
        vScreen = position.xy;
        gl_Position = vec4(position.xy, 1.0, 1.0);
      }`,
    fragmentShader: /* glsl */ `
      varying vec2 vScreen;
      uniform vec3 centre;
      uniform vec3 edge;
      void main() {
        float away = length((vScreen - vec2(0.0, 0.12)) * vec2(0.62, 0.78));
        vec3 color = mix(centre, edge, smoothstep(0.0, 1.15, away));
        gl_FragColor = vec4(color, 1.0);
        #include <colorspace_fragment>
        float grain = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
        gl_FragColor.rgb += (grain - 0.5) / 255.0;
      }`,
  });
  const backdrop = new Mesh(new PlaneGeometry(2, 2), material);
  backdrop.frustumCulled = false;
  backdrop.renderOrder = -1;
  return backdrop;
}
