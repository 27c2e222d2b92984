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

const SHADOW_MAP_SIZE = 2048;

/** Lights for a camera in front of the face; turn the group with the camera, so that every view is well lit. */
export function createLights(): Group {
  const lights = new Group();
  const key = new DirectionalLight(0xfff4ea, 2.3);
  key.position.set(-0.26, 0.27, 0.33);
  castSoftShadow(key);
  const fill = new DirectionalLight(0xe6ebf7, 0.42);
  fill.position.set(0.36, 0.02, 0.3);
  // From so far behind, these touch only edges, and no shadow of theirs is missed.
  const rimLeft = new DirectionalLight(0xe8efff, 1.9);
  rimLeft.position.set(0.26, 0.16, -0.36);
  const rimRight = new DirectionalLight(0xffecd8, 1.1);
  rimRight.position.set(-0.28, 0.12, -0.36);
  lights.add(
    key,
    key.target,
    fill,
    rimLeft,
    rimRight,
    new HemisphereLight(0xeceef4, 0x6e5244, 0.5),
  );
  return lights;
}

function castSoftShadow(light: DirectionalLight): void {
  light.castShadow = true;
  light.shadow.mapSize.set(SHADOW_MAP_SIZE, SHADOW_MAP_SIZE);
  light.shadow.radius = 9;
  // Some of the key's light comes back from the room, also where it does not reach.
  light.shadow.intensity = 0.82;
  light.shadow.bias = -0.0004;
  light.shadow.normalBias = 0.0011;
  const camera = light.shadow.camera;
  [camera.left, camera.right, camera.top, camera.bottom] = [-0.17, 0.17, 0.17, -0.21];
  [camera.near, camera.far] = [0.1, 0.9];
}

/** What glossy surfaces mirror: a dim room with a large box at the key's side, a strip at the other, a ceiling. */
export function createEnvironment(renderer: WebGLRenderer): Texture {
  const room = new Scene();
  room.background = new Color(0x22262c);
  room.add(
    softBox([-3.6, 3.4, 5], [2.6, 3.2], 11),
    softBox([5.4, 0.6, 3.4], [1.2, 4.5], 3.2),
    softBox([0, 7, -1.5], [6, 3.5], 2.6),
    softBox([4.5, 2, -5], [2.5, 5], 3),
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

/** A quiet backdrop, lighter behind the head; dithered, since dark gradients band in 8 bits. */
export function createBackdrop(): Mesh {
  const material = new ShaderMaterial({
    depthTest: false,
    depthWrite: false,
    uniforms: {
      centre: { value: new Color('#3a4048') },
      edge: { value: new Color('#14171b') },
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
