// The muscles drawn over the face: bundles of fibres that go with the skin and glow as they contract.

import {
  BufferGeometry,
  DynamicDrawUsage,
  Float32BufferAttribute,
  Mesh,
  ShaderMaterial,
} from 'three';
import { fibresOn } from './draped';
import type { Ground } from './ground';
import { nearestPoint } from './ground';
import type { Fibre, MuscleForm, Point } from './muscle-shape';
import { outward } from './muscle-shape';
import type { Ride } from './riding';
import { rideOf, STAY } from './riding';
import { minus, plus } from './vector';

const METRES = 1e-3;
const MILLIMETRES = 1e3;
const SIDES = 6;
/** Drawn after skin, corneas and hair. */
const LAST = 9;
/** Time in which a shown activation follows the one that is told, e-fold [ms]. */
const FOLLOW_MS = 90;
const STILL = 2e-3;

interface Vertex {
  muscle: number;
  /** Streamed point that it goes with. */
  tied: number;
  follows: number;
  /** By how much of the jaw the bone end of its fibre rides, and where the skin end is at rest [mm]. */
  rides: number;
  end: Point;
}

export class MuscleView {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
  private readonly names: string[];
  private readonly vertices: Vertex[] = [];
  /** [mm] */
  private readonly rest: Float32Array;
  private readonly shown: Float32Array;
  private wanted: Float32Array;
  private steppedAt = 0;

  constructor(
    muscles: readonly MuscleForm[],
    private readonly ground: Ground,
  ) {
    this.names = muscles.map(({ name }) => name);
    this.shown = new Float32Array(muscles.length);
    this.wanted = new Float32Array(muscles.length);
    const built = { positions: [] as number[], normals: [] as number[], index: [] as number[] };
    muscles.forEach((muscle, at) => {
      for (const fibre of fibresOn(muscle, ground)) this.addTube(fibre, at, built);
    });
    this.rest = new Float32Array(built.positions);
    const geometry = new BufferGeometry();
    geometry.setIndex(built.index);
    geometry.setAttribute('position', moving(built.positions, 3));
    geometry.setAttribute('normal', new Float32BufferAttribute(built.normals, 3));
    geometry.setAttribute('activation', moving(new Array<number>(this.vertices.length).fill(0), 1));
    this.mesh = new Mesh(geometry, createFlesh());
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = LAST;
    // They lie under the skin, and are seen through it; among each other the near one hides the far.
    this.mesh.onBeforeRender = (renderer) => {
      renderer.clearDepth();
    };
    this.move();
  }

  /** How far each muscle contracts, by name. */
  show(activations: Readonly<Record<string, number>>): void {
    this.wanted = Float32Array.from(this.names, (name) => Math.max(0, activations[name] ?? 0));
  }

  /** Take the glow further; tells whether it goes on. */
  step(now: number): boolean {
    const share = 1 - Math.exp(-Math.min(100, now - this.steppedAt) / FOLLOW_MS);
    this.steppedAt = now;
    let goesOn = false;
    this.shown.forEach((value, at) => {
      const left = this.wanted[at]! - value;
      goesOn ||= Math.abs(left) > STILL;
      this.shown[at] = Math.abs(left) > STILL ? value + share * left : this.wanted[at]!;
    });
    const glow = this.mesh.geometry.getAttribute('activation');
    this.vertices.forEach(({ muscle }, at) => glow.setX(at, this.shown[muscle]!));
    glow.needsUpdate = true;
    return goesOn;
  }

  /** Go where skin and jaw have gone. */
  move(): void {
    const positions = this.mesh.geometry.getAttribute('position');
    const jaw = this.ground.jaw();
    const known = new Map<number, Ride>();
    this.vertices.forEach(({ tied, follows, rides, end }, at) => {
      const ride = known.get(rides) ?? rideOf(jaw, rides);
      known.set(rides, ride);
      let place: Point = [this.rest[3 * at]!, this.rest[3 * at + 1]!, this.rest[3 * at + 2]!];
      const [x, y, z] = this.ground.displacement(tied);
      let besides: Point = [MILLIMETRES * x, MILLIMETRES * y, MILLIMETRES * z];
      if (ride !== STAY) {
        place = ride.to(place);
        besides = minus(plus(end, besides), ride.to(end));
      }
      const [right, up, out] = plus(place, besides, follows);
      positions.setXYZ(at, METRES * right, METRES * up, METRES * out);
    });
    positions.needsUpdate = true;
  }

  dispose(): void {
    this.mesh.removeFromParent();
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }

  private addTube(
    { points, follows, radii, rides, spread }: Fibre,
    muscle: number,
    built: { positions: number[]; normals: number[]; index: number[] },
  ): void {
    const first = this.vertices.length;
    // Each point of a ring goes with the skin over it; all of a straight fibre with its bone, and with its skin end.
    const end = points.at(-1)!;
    const under = nearestPoint(this.ground, end);
    points.forEach((point, at) => {
      const tied = spread ? nearestPoint(this.ground, point) : under;
      const [out, aside] = frameAt(points, at);
      for (let side = 0; side < SIDES; side++) {
        const angle = (2 * Math.PI * side) / SIDES;
        const normal = out.map((o, axis) => o * Math.cos(angle) + aside[axis]! * Math.sin(angle));
        built.normals.push(...normal);
        built.positions.push(...point.map((p, axis) => p + radii[at]! * normal[axis]!));
        this.vertices.push({ muscle, tied, follows: follows[at]!, rides, end });
      }
      if (at === 0) return;
      for (let side = 0; side < SIDES; side++) {
        const next = (side + 1) % SIDES;
        const [a, b] = [first + (at - 1) * SIDES + side, first + (at - 1) * SIDES + next];
        built.index.push(a, b, b + SIDES, a, b + SIDES, a + SIDES);
      }
    });
  }
}

/** Out of the head, and across that and the fibre, at one of its points. */
function frameAt(points: readonly Point[], at: number): [Point, Point] {
  const from = points[Math.max(0, at - 1)]!;
  const to = points[Math.min(points.length - 1, at + 1)]!;
  const along = to.map((value, axis) => value - from[axis]!) as unknown as Point;
  const length = Math.max(1e-9, Math.hypot(...along));
  const out = outward(points[at]!);
  const lean = along.reduce((sum, value, axis) => sum + (value / length) * out[axis]!, 0);
  const upright = out.map((value, axis) => value - (lean * along[axis]!) / length);
  const size = Math.max(1e-9, Math.hypot(...upright));
  const normal = upright.map((value) => value / size) as unknown as Point;
  const aside: Point = [
    (along[1] * normal[2] - along[2] * normal[1]) / length,
    (along[2] * normal[0] - along[0] * normal[2]) / length,
    (along[0] * normal[1] - along[1] * normal[0]) / length,
  ];
  return [normal, aside];
}

function moving(values: number[], size: number): Float32BufferAttribute {
  const attribute = new Float32BufferAttribute(values, size);
  attribute.setUsage(DynamicDrawUsage);
  return attribute;
}

function createFlesh(): ShaderMaterial {
  return new ShaderMaterial({
    transparent: true,
    vertexShader: /* glsl */ `
      attribute float activation;
      varying float vActivation;
      varying vec3 vNormal;
      varying float vFacing;
      varying vec3 vPlace;
      void main() {
        vActivation = activation;
        vPlace = position;
        vNormal = normalize(normalMatrix * normal);
        vec4 seen = modelViewMatrix * vec4(position, 1.0);
        // What lies on the far side of the head is not seen through it.
        vec3 out3 = normalize(normalMatrix * normalize(vec3(position.x, 0.0, position.z)));
        vFacing = dot(out3, normalize(-seen.xyz));
        gl_Position = projectionMatrix * seen;
      }`,
    fragmentShader: /* glsl */ `
      varying float vActivation;
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
        float light = 0.38 + 0.62 * max(0.0, dot(normalize(vNormal), normalize(vec3(-0.35, 0.5, 0.8))));
        color *= mix(light, 1.0, 0.6 * min(1.0, power));
        float seen = smoothstep(0.0, 0.3, vFacing) * mix(0.62, 0.98, min(1.0, power * 1.6));
        if (seen < 0.01) discard;
        gl_FragColor = vec4(color, seen);
        #include <colorspace_fragment>
      }`,
  });
}
