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
import type { LightPreset, SoftBox } from './light-presets';

const SHADOW_MAP_SIZE = 1024;

export interface StudioLights {
  /** Turn it with the camera, so that every view is well lit. */
  group: Group;
  /** Set every lamp as a preset says. */
  set(preset: LightPreset): void;
}

/** The lamps, dark until a preset is set. */
export function createLights(): StudioLights {
  const [key, fill, rimLeft, rimRight] = [1, 2, 3, 4].map(() => new DirectionalLight()) as [
    DirectionalLight,
    DirectionalLight,
    DirectionalLight,
    DirectionalLight,
  ];
  castSoftShadow(key);
  const sky = new HemisphereLight();
  const group = new Group();
  group.add(key, key.target, fill, rimLeft, rimRight, sky);
  const light = (lamp: DirectionalLight, { color, intensity, from }: LightPreset['fill']): void => {
    lamp.color.set(color);
    lamp.intensity = intensity;
    lamp.position.set(...from);
  };
  return {
    group,
    set(preset) {
      light(key, preset.key);
      key.shadow.intensity = preset.key.shadow;
      light(fill, preset.fill);
      light(rimLeft, preset.rims[0]);
      light(rimRight, preset.rims[1]);
      sky.color.set(preset.sky.above);
      sky.groundColor.set(preset.sky.below);
      sky.intensity = preset.sky.intensity;
    },
  };
}

function castSoftShadow(light: DirectionalLight): void {
  light.castShadow = true;
  light.shadow.mapSize.set(SHADOW_MAP_SIZE, SHADOW_MAP_SIZE);
  // A soft box as near as a portrait's: what stands off by 2 cm throws an edge of about 8 mm.
  light.shadow.radius = 12;
  light.shadow.bias = -0.0008;
  light.shadow.normalBias = 0.0014;
  const camera = light.shadow.camera;
  [camera.left, camera.right, camera.top, camera.bottom] = [-0.17, 0.17, 0.17, -0.21];
  [camera.near, camera.far] = [0.1, 0.9];
}

/** What glossy surfaces mirror: a room and its soft boxes. */
export function createEnvironment(
  renderer: WebGLRenderer,
  { walls, boxes }: LightPreset['room'],
): Texture {
  const room = new Scene();
  room.background = new Color(walls);
  room.add(...boxes.map(softBox));
  const generator = new PMREMGenerator(renderer);
  const environment = generator.fromScene(room, 0.01).texture;
  generator.dispose();
  return environment;
}

function softBox({ from, size, radiance }: SoftBox): Mesh {
  const box = new Mesh(
    new PlaneGeometry(...size),
    new MeshBasicMaterial({ color: new Color(radiance, radiance, radiance), side: DoubleSide }),
  );
  box.position.set(...from);
  box.lookAt(0, 0, 0);
  return box;
}

/** What may stand behind the face: as the page is, dark or light. */
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
