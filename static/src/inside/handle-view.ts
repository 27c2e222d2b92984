// The handles of a muscle on the face, and the outline of where it acts.

import type { InterleavedBufferAttribute } from 'three';
import { Color, Group, Mesh, MeshBasicMaterial, SphereGeometry, Vector3 } from 'three';
import { LineMaterial } from 'three/addons/lines/LineMaterial.js';
import { LineSegments2 } from 'three/addons/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';
import type { Carrier } from '../ground';
import type { MuscleForm } from '../muscle-shape';
import type { CarriedHandle } from './carried';
import { carriedHandles, carriedZone } from './carried';
import type { Handle } from './editing';

const METRES = 1e-3;
/** Of a handle's ball, and of the dark rim around it [m]. */
const RADIUS = 2.8e-3;
const RIM = 3.7e-3;
/** Of a handle: rim and ball. */
const BALLS = 2;
/** Of the outline, and of the dark line under it, which holds it on bright skin [CSS px]. */
const WIDTH = 2;
const CASING = 4.5;
/** Drawn after the muscles. */
const LAST = 12;
/** Bone, skin, and the numbers of a muscle. */
const COLORS: Record<Handle['along'], string> = {
  bone: '#f4ead2',
  skin: '#ff9d6b',
  line: '#5fc8ff',
  arc: '#b08bff',
  plane: '#ff9d6b',
};

export class HandleView {
  readonly group = new Group();
  handles: CarriedHandle[] = [];
  private muscle: MuscleForm | null = null;
  private readonly ball = new SphereGeometry(RADIUS, 16, 12);
  private readonly rim = new SphereGeometry(RIM, 16, 12);
  private readonly zone = new LineSegments2(
    new LineSegmentsGeometry(),
    new LineMaterial({ color: '#7fd4ff', linewidth: WIDTH, transparent: true, depthTest: false }),
  );
  private readonly casing = new LineSegments2(
    this.zone.geometry,
    new LineMaterial({
      color: '#0b1a26',
      linewidth: CASING,
      transparent: true,
      opacity: 0.6,
      depthTest: false,
    }),
  );
  private readonly balls = new Group();
  private readonly made: MeshBasicMaterial[] = [];

  constructor() {
    this.casing.renderOrder = LAST;
    this.zone.renderOrder = LAST + 1;
    for (const line of [this.casing, this.zone]) line.frustumCulled = false;
    this.group.add(this.casing, this.zone, this.balls);
  }

  /** Show the handles of a muscle, carried by the face as it stands; of none, nothing. */
  show(muscle: MuscleForm | null, by: Carrier): void {
    this.muscle = muscle;
    this.clear();
    this.zone.geometry.dispose();
    this.zone.geometry = this.casing.geometry = new LineSegmentsGeometry();
    this.handles = muscle === null ? [] : carriedHandles(muscle, by);
    for (const { along } of this.handles) {
      for (const [geometry, color, order] of [
        [this.rim, '#15181c', LAST + 2],
        [this.ball, COLORS[along], LAST + 3],
      ] as const) {
        const material = new MeshBasicMaterial({
          color: new Color(color),
          depthTest: false,
          transparent: true,
        });
        this.made.push(material);
        const mesh = new Mesh(geometry, material);
        mesh.renderOrder = order;
        this.balls.add(mesh);
      }
    }
    this.place(by);
  }

  /** The face has moved: go where it has carried the muscle. */
  move(by: Carrier): void {
    if (this.muscle === null) return;
    this.handles = carriedHandles(this.muscle, by);
    this.place(by);
  }

  private place(by: Carrier): void {
    this.balls.children.forEach((ball, at) => {
      const { drawn } = this.handles[Math.floor(at / BALLS)]!;
      ball.position.set(drawn[0] * METRES, drawn[1] * METRES, drawn[2] * METRES);
    });
    const lines = this.muscle === null ? [] : carriedZone(this.muscle, by);
    const places = lines.flatMap((line) =>
      line.slice(1).flatMap((point, at) => [...line[at]!, ...point]),
    );
    this.zone.visible = this.casing.visible = places.length > 0;
    const there = this.zone.geometry.getAttribute('instanceStart') as
      InterleavedBufferAttribute | undefined;
    const metres = places.map((value) => value * METRES);
    if (there === undefined) {
      if (this.zone.visible) this.zone.geometry.setPositions(metres);
      return;
    }
    there.data.array.set(metres);
    there.data.needsUpdate = true;
  }

  /** Where a place of the head's frame [mm] is in the world. */
  world(place: readonly [number, number, number]): Vector3 {
    const at = new Vector3(...place).multiplyScalar(METRES);
    return this.group.localToWorld(at);
  }

  dispose(): void {
    this.group.removeFromParent();
    this.clear();
    this.ball.dispose();
    this.rim.dispose();
    this.zone.geometry.dispose();
    this.zone.material.dispose();
    this.casing.material.dispose();
  }

  private clear(): void {
    this.balls.clear();
    for (const material of this.made.splice(0)) material.dispose();
  }
}
