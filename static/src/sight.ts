// From places of the page to what is drawn there, and back.

import type { Mesh, Object3D, PerspectiveCamera, Vector3 } from 'three';
import { Raycaster, Vector2 } from 'three';

/** What a pointer touches of a mesh. */
export interface Hit {
  corners: [number, number, number];
  /** Of the corners, at the place. */
  weights: [number, number, number];
  /** In the mesh's own frame [mm]. */
  place: [number, number, number];
}

export class Sight {
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly camera: PerspectiveCamera,
    /** What the camera looks at. */
    private readonly target: Vector3,
  ) {}

  /** What is under a place of the page, of one mesh; null where there is nothing of it. */
  hit(mesh: Mesh, x: number, y: number): Hit | null {
    const [found] = this.ray(x, y).intersectObject(mesh, false);
    if (found?.face == null || found.barycoord == null) return null;
    const { a, b, c } = found.face;
    const place = mesh.worldToLocal(found.point).multiplyScalar(1000);
    return { corners: [a, b, c], weights: found.barycoord.toArray(), place: place.toArray() };
  }

  /** The line of sight through a place of the page, in the frame of an object [mm]. */
  rayIn(
    object: Object3D,
    x: number,
    y: number,
  ): Record<'origin' | 'direction', [number, number, number]> {
    const { origin, direction } = this.ray(x, y).ray;
    const towards = object.worldToLocal(origin.clone().add(direction));
    const from = object.worldToLocal(origin.clone());
    return {
      origin: from.clone().multiplyScalar(1000).toArray(),
      direction: towards.sub(from).normalize().toArray(),
    };
  }

  /** Where on the page a place of the world is drawn [CSS px]. */
  screenPlace(place: Vector3): { x: number; y: number } {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const at = place.clone().project(this.camera);
    return { x: left + (0.5 + at.x / 2) * width, y: top + (0.5 - at.y / 2) * height };
  }

  /** Whether a place of the head's surface looks this way, and not off the far side. */
  facing(place: Vector3): boolean {
    const seen = this.camera.position.clone().sub(this.target);
    return place.x * seen.x + place.z * seen.z > 0;
  }

  private ray(x: number, y: number): Raycaster {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const at = new Vector2((2 * (x - left)) / width - 1, 1 - (2 * (y - top)) / height);
    const caster = new Raycaster();
    caster.setFromCamera(at, this.camera);
    return caster;
  }
}
