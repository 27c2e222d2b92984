// The skull's side that bone ends are dragged along: at rest, and as the jaw stands. Never drawn.

import type { BufferGeometry } from 'three';
import { BufferAttribute, Mesh } from 'three';
import type { JawPose } from '../riding';
import { rideOf, STAY } from '../riding';
import type { Hit } from '../sight';
import type { Point } from '../vector';
import { plus } from '../vector';

const METRES = 1e-3;

export class Skull {
  readonly mesh: Mesh<BufferGeometry>;
  private readonly rest: ArrayLike<number>;
  /** Of the jaw that each of its points rides by. */
  private readonly shares: ArrayLike<number>;

  /** @param bone the sheet of the tissue file, in metres; its `_jaw` says how far each point rides the jaw. */
  constructor(bone: BufferGeometry) {
    this.rest = bone.getAttribute('position').array;
    this.shares = bone.getAttribute('_jaw').array;
    const geometry = bone.clone();
    geometry.setAttribute('position', new BufferAttribute(Float32Array.from(this.rest), 3));
    this.mesh = new Mesh(geometry);
    this.mesh.visible = false;
  }

  /** Be touched as the jaw stands. */
  stand(jaw: JawPose): void {
    const { geometry } = this.mesh;
    const places = geometry.getAttribute('position');
    for (let at = 0; at < this.shares.length; at++) {
      const place = this.restPlace(at);
      const ride = rideOf(jaw, this.shares[at]!);
      const [x, y, z] = ride === STAY ? place : ride.to(place);
      places.setXYZ(at, x * METRES, y * METRES, z * METRES);
    }
    geometry.computeBoundingSphere();
  }

  /** Where a place on one of its triangles is at rest [mm, head frame], and by how much of the jaw it rides. */
  under({ corners, weights }: Pick<Hit, 'corners' | 'weights'>): { place: Point; share: number } {
    let [place, share]: [Point, number] = [[0, 0, 0], 0];
    corners.forEach((corner, at) => {
      place = plus(place, this.restPlace(corner), weights[at]);
      share += weights[at]! * this.shares[corner]!;
    });
    return { place, share };
  }

  dispose(): void {
    this.mesh.geometry.dispose();
  }

  private restPlace(at: number): Point {
    return [0, 1, 2].map((axis) => this.rest[3 * at + axis]! / METRES) as unknown as Point;
  }
}
