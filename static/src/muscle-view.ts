// The muscles drawn over the face: bundles of fibres that go with the skin and glow as they contract.

import type { ShaderMaterial } from 'three';
import { BufferGeometry, DynamicDrawUsage, Float32BufferAttribute, Mesh } from 'three';
import { evenAround } from './around';
import { fibresOn } from './draped';
import type { Ground } from './ground';
import { nearestPoint } from './ground';
import { createFlesh } from './muscle-flesh';
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
  /** Streamed point that it goes with; of a ring its place among those of all rings. */
  tied: number;
  onRing: boolean;
  follows: number;
  /** By how much of the jaw the bone end of its fibre rides, and where the skin end is at rest [mm]. */
  rides: number;
  end: Point;
}

export class MuscleView {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
  private readonly names: string[];
  private readonly vertices: Vertex[] = [];
  /** Of each ring the streamed points that its own go with. */
  private readonly rings: number[][] = [];
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
    const of = this.vertices.map(({ muscle }) => muscle);
    geometry.setAttribute('muscle', new Float32BufferAttribute(of, 1));
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

  /** The muscle that is in hand stands out from the others; an empty name for none. */
  hold(muscle: string): void {
    this.mesh.material.uniforms.inHand!.value = this.names.indexOf(muscle);
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
    const around = this.rings.map((points) =>
      evenAround(
        Float64Array.from(points.flatMap((point) => [...this.ground.displacement(point)])),
      ),
    );
    const ways = Float64Array.from(around.flatMap((ring) => [...ring]));
    this.vertices.forEach(({ tied, onRing, follows, rides, end }, at) => {
      const ride = known.get(rides) ?? rideOf(jaw, rides);
      known.set(rides, ride);
      let place: Point = [this.rest[3 * at]!, this.rest[3 * at + 1]!, this.rest[3 * at + 2]!];
      const [x, y, z] = onRing
        ? [ways[3 * tied]!, ways[3 * tied + 1]!, ways[3 * tied + 2]!]
        : this.ground.displacement(tied);
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
    const before = this.rings.flat().length;
    if (spread) this.rings.push(points.map((point) => nearestPoint(this.ground, point)));
    points.forEach((point, at) => {
      const tied = spread ? before + at : under;
      const [out, aside] = frameAt(points, at);
      for (let side = 0; side < SIDES; side++) {
        const angle = (2 * Math.PI * side) / SIDES;
        const normal = out.map((o, axis) => o * Math.cos(angle) + aside[axis]! * Math.sin(angle));
        built.normals.push(...normal);
        built.positions.push(...point.map((p, axis) => p + radii[at]! * normal[axis]!));
        this.vertices.push({ muscle, tied, onRing: spread, follows: follows[at]!, rides, end });
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
