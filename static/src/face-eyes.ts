// What both eyes are told as they turn and lids close over them.

import { Matrix4 } from 'three';
import { EyeSetting } from './eye-shader';
import type { FaceNodes } from './face-nodes';
import type { Triple } from './pose';

/** Gives a vertex of the skin as it is drawn [mm, head frame]. */
type Drawn = (vertex: number) => Triple;

const MILLIMETRES = 1000;
const EYE_NODES = ['eye.L', 'eye.R'] as const;

export class FaceEyes {
  /** By the node that an eye is. */
  readonly settings: Readonly<Record<string, EyeSetting>>;
  private readonly centers: Readonly<Record<string, readonly [number, number, number]>>;

  /**
   * @param centers of the left eye and the right one [m, head frame].
   * @param map the picture of an iris.
   */
  constructor(
    centers: readonly (readonly [number, number, number])[],
    map: ConstructorParameters<typeof EyeSetting>[1],
  ) {
    this.centers = Object.fromEntries(centers.map((center, i) => [EYE_NODES[i]!, center]));
    this.settings = { 'eye.L': new EyeSetting(1, map), 'eye.R': new EyeSetting(-1, map) };
  }

  /** Tell the eyes how they are turned, and where the lids' edges are. */
  update(nodes: FaceNodes, landmarks: Readonly<Record<string, number>>, drawn: Drawn): void {
    for (const name of EYE_NODES) {
      const setting = this.settings[name]!;
      const node = nodes.get(name);
      if (node !== undefined) {
        const turned = new Matrix4().makeRotationFromQuaternion(node.quaternion);
        setting.turn.value.setFromMatrix4(turned);
      }
      const center = this.centers[name];
      const side = name.slice(-1);
      const places = ['en', 'ex', 'ps', 'pi'].flatMap((stem) => landmarks[`${stem}.${side}`] ?? []);
      if (places.length < 4) continue;
      if (center === undefined) continue;
      const [inner, outer, upper, lower] = places.map((index) => {
        const place = drawn(index);
        return place.map((at, axis) => at - center[axis]! * MILLIMETRES) as Triple;
      });
      setting.corners.value.set(inner![0], inner![1], outer![0], outer![1]);
      setting.lids.value.setX(upper![1]).setY(lower![1]);
    }
  }
}
