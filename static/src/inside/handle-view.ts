// The handles of a muscle on the face, and the outline of where it acts.

import { Color, Group, Mesh, MeshBasicMaterial, SphereGeometry, Vector3 } from 'three';
import { LineMaterial } from 'three/addons/lines/LineMaterial.js';
import { LineSegments2 } from 'three/addons/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';
import type { MuscleForm } from '../muscle-shape';
import type { Handle } from './editing';
import { handlesOf, zoneOf } from './editing';

const METRES = 1e-3;
/** Of a handle's ball, and of the dark rim around it [m]. */
const RADIUS = 2.8e-3;
const RIM = 3.7e-3;
/** Of the outline [CSS px]. */
const WIDTH = 2;
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
  handles: Handle[] = [];
  private readonly ball = new SphereGeometry(RADIUS, 16, 12);
  private readonly rim = new SphereGeometry(RIM, 16, 12);
  private readonly zone = new LineSegments2(
    new LineSegmentsGeometry(),
    new LineMaterial({ color: '#7fd4ff', linewidth: WIDTH, transparent: true, depthTest: false }),
  );
  private readonly balls = new Group();
  private readonly made: MeshBasicMaterial[] = [];

  constructor() {
    this.zone.renderOrder = LAST;
    this.zone.frustumCulled = false;
    this.group.add(this.zone, this.balls);
  }

  /** Show the handles of a muscle; of none, nothing. */
  show(muscle: MuscleForm | null): void {
    this.handles = muscle === null ? [] : handlesOf(muscle);
    const places = (muscle === null ? [] : zoneOf(muscle)).flatMap((row) =>
      row.slice(1).flatMap((point, at) => [...row[at]!, ...point]),
    );
    this.zone.geometry.dispose();
    this.zone.geometry = new LineSegmentsGeometry();
    this.zone.visible = places.length > 0;
    if (places.length > 0) this.zone.geometry.setPositions(places.map((value) => value * METRES));
    this.clear();
    for (const { place, along } of this.handles) {
      for (const [geometry, color, order] of [
        [this.rim, '#15181c', LAST + 1],
        [this.ball, COLORS[along], LAST + 2],
      ] as const) {
        const material = new MeshBasicMaterial({
          color: new Color(color),
          depthTest: false,
          transparent: true,
        });
        this.made.push(material);
        const mesh = new Mesh(geometry, material);
        mesh.renderOrder = order;
        mesh.position.set(...(place.map((value) => value * METRES) as [number, number, number]));
        this.balls.add(mesh);
      }
    }
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
  }

  private clear(): void {
    this.balls.clear();
    for (const material of this.made.splice(0)) material.dispose();
  }
}
