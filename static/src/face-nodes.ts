// The parts of a head that turn and slide as a whole: head, jaw, eyes, tongue.

import type { Mesh, Object3D } from 'three';
import { Euler, Quaternion, Vector3 } from 'three';
import { meshes, nodeName } from './gltf-nodes';
import type { FacePose } from './pose';
import type { JawPose } from './riding';
import { SHUT } from './riding';

/** How far a file puts the tongue out that does not say [m]. */
const DEFAULT_TONGUE_THRUST = 0.04;
const RADIANS = Math.PI / 180;
const MILLIMETRES = 1000;

export class FaceNodes {
  private readonly nodes = new Map<string, Object3D>();
  private readonly jawRest: Vector3;
  /** Where the jaw's hinge is at rest [mm, head frame]. */
  private readonly hinge: Vector3;
  private readonly headRest: Vector3;
  private readonly tongue: Mesh | undefined;

  constructor(private readonly root: Object3D) {
    root.traverse((node) => this.nodes.set(nodeName(node), node));
    this.jawRest = this.get('jaw')?.position.clone() ?? new Vector3();
    this.hinge = new Vector3(...[0, 1, 2].map((axis) => this.origin('jaw', axis)));
    this.hinge.multiplyScalar(MILLIMETRES);
    this.headRest = this.get('head')?.position.clone() ?? new Vector3();
    this.tongue = meshes(root).find((mesh) => nodeName(mesh) === 'tongue');
  }

  /** A node by the name that the file gives it. */
  get(name: string): Object3D | undefined {
    return this.nodes.get(name);
  }

  /** Take on a pose; tells whether that changed anything. */
  apply(pose: FacePose): boolean {
    return [
      this.turn('head', rotation(pose.head[0], pose.head[1], pose.head[2])),
      this.turn('eye.L', rotation(pose.gaze[0], pose.gaze[1], 0)),
      this.turn('eye.R', rotation(pose.gaze[2], pose.gaze[3], 0)),
      this.turn('jaw', new Quaternion(...pose.jawQuaternion)),
      this.slide('jaw', this.jawRest, pose.jawOffset),
      this.slide('head', this.headRest, [0, 0, pose.headThrust]),
      this.putOutTongue(pose.tongueThrust),
    ].includes(true);
  }

  /** The jaw as it stands; shut on a face without one. */
  get jaw(): JawPose {
    const jaw = this.get('jaw');
    if (jaw === undefined) return SHUT;
    const offset = jaw.position.clone().sub(this.jawRest).multiplyScalar(MILLIMETRES);
    return {
      hinge: this.hinge.toArray(),
      offset: offset.toArray(),
      quaternion: jaw.quaternion.toArray(),
    };
  }

  /** Have something that lies in the head's frame [m] go with the head. */
  carry(object: Object3D): void {
    const head = this.get('head');
    const [x, y, z] = [0, 1, 2].map((axis) => this.origin('head', axis)) as [
      number,
      number,
      number,
    ];
    if (head === undefined) {
      this.root.add(object);
      return;
    }
    object.position.set(-x, -y, -z);
    head.add(object);
  }

  /** Where a node's own origin lies in the head's frame at rest [m]. */
  origin(name: string, axis: number): number {
    let sum = 0;
    for (
      let node = this.nodes.get(name);
      node !== undefined && node !== this.root;
      node = node.parent ?? undefined
    ) {
      sum += node.position.getComponent(axis);
    }
    return sum;
  }

  private turn(name: string, rotated: Quaternion): boolean {
    const node = this.nodes.get(name);
    if (node === undefined || node.quaternion.equals(rotated)) return false;
    node.quaternion.copy(rotated);
    return true;
  }

  private slide(name: string, rest: Vector3, offset: readonly [number, number, number]): boolean {
    const node = this.nodes.get(name);
    const place = new Vector3(...offset).add(rest);
    if (node === undefined || node.position.equals(place)) return false;
    node.position.copy(place);
    return true;
  }

  /** The tongue's one morph target is the tongue put out by `thrust` of its extras [m]. */
  private putOutTongue(thrust: number): boolean {
    const tongue = this.tongue;
    if (tongue?.morphTargetInfluences === undefined) return false;
    const full = (tongue.userData as { thrust?: number }).thrust ?? DEFAULT_TONGUE_THRUST;
    const weight = thrust / full;
    if (tongue.morphTargetInfluences[0] === weight) return false;
    tongue.morphTargetInfluences[0] = weight;
    return true;
  }
}

/** Yaw to the face's left, pitch up, roll to the left shoulder, in degrees. */
function rotation(yaw: number, pitch: number, roll: number): Quaternion {
  return new Quaternion().setFromEuler(
    new Euler(-pitch * RADIANS, yaw * RADIANS, -roll * RADIANS, 'YXZ'),
  );
}
