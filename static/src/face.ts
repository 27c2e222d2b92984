// The face as three.js draws it: surface.glb in, poses of the tissue surface applied.

import type {
  BufferAttribute,
  BufferGeometry,
  Group,
  InterleavedBufferAttribute,
  Material,
  MeshStandardMaterial,
  Object3D,
  Plane,
} from 'three';
import {
  DynamicDrawUsage,
  Euler,
  Float32BufferAttribute,
  MathUtils,
  Matrix4,
  Mesh,
  Quaternion,
  Vector3,
} from 'three';
import type { GLTF } from 'three/addons/loaders/GLTFLoader.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { EyeSetting } from './eye-shader';
import { createMaterial } from './materials';
import { MovingNormals } from './normals';
import { mouthWalls, skinForm } from './skin-form';
import { strandSides } from './strand-sides';
import { strandTangents } from './strand-tangents';
import { Strands } from './strands';
import type { Eyeball } from './surface';
import { DrawnSurface } from './surface';
import type { MapName } from './textures';
import { FaceMaps, mapAddresses } from './textures';
import type { Gauges } from './wrinkles';
import { Wrinkles } from './wrinkles';

/** One moment of the face; a decoded frame is one. */
export interface FacePose {
  vertexCount: number;
  moved: ArrayLike<number>;
  /** Three grid steps per moved point. */
  displacements: ArrayLike<number>;
  jawQuaternion: readonly [number, number, number, number];
  /** [m] from the hinge's rest place. */
  jawOffset: readonly [number, number, number];
  /** Left yaw, left pitch, right yaw, right pitch [degrees]. */
  gaze: readonly [number, number, number, number];
  /** Yaw, pitch, roll [degrees]. */
  head: readonly [number, number, number];
  /** How far the head is held forward, and the tongue put out [m]. */
  headThrust: number;
  tongueThrust: number;
}

export type Triple = [number, number, number];

interface SkinExtras {
  map: { indptr: number; indices: number; weights: number; columns: number };
  lids?: { vertices: number; eyes: number; clearance: number } | null;
  eyes?: {
    center: Triple;
    radius: number;
    bulge: number;
    bulge_radius: number;
    bulge_power?: number;
    ball_radius_drawn: number;
  }[];
  landmarks?: Record<string, number>;
  names?: string[];
  regions?: number;
  region_names?: string[];
  seams?: number;
  wrinkles?: Record<keyof Gauges, number> | null;
}

/** What the file says of the skin besides its mesh. */
interface Skin {
  surface: DrawnSurface;
  roots: Map<Mesh, ArrayLike<number>>;
  maps: Partial<Record<MapName, string>>;
  regions: ArrayLike<number> | null;
  /** First of the vertices that lie at the same place, for each. */
  seams: ArrayLike<number> | null;
  gauges: Gauges | null;
}

interface RidingStrands {
  strands: Strands;
  attribute: BufferAttribute;
}

/** Told how much is done, out of how much. */
type OnProgress = (done: number, total: number) => void;

const MILLIMETRES = 1000;
/** How far a file puts the tongue out that does not say [m]. */
const DEFAULT_TONGUE_THRUST = 0.04;
const DEFAULT_GRID = 2e-5;
/** What is wet below this height is in the mouth; light fades between lips and throat [m, head frame]. */
const MOUTH_TOP = -0.04;
const LIPS = 0.094;
const THROAT = 0.045;
const DARKEST = { wet: 0.4, teeth: 0.6 };
/** A face that reaches lower than this [m] has a neck, which fades from its cut, uneven by so many mm, up to there. */
const NECK_BELOW = -0.14;
const NECK_END = 13;
const NECK_FADE = 60;
/** What is blended comes after what is opaque: skin, which fades at the neck, then corneas, then hair over both. */
const DRAWN_AFTER: Record<string, number> = { skin: 1, cornea: 2, hair: 3 };
const EYE_NODES = ['eye.L', 'eye.R'] as const;
const RADIANS = Math.PI / 180;

export class Face {
  readonly root: Group;
  readonly landmarks: Readonly<Record<string, number>>;
  readonly names: readonly string[];
  /** Labels of the regions of its skin. */
  readonly regionNames: readonly string[];
  readonly skin: Mesh;
  /** Heights between which the neck fades into the ground [mm]; null for a mask without a neck. */
  readonly neckFade: readonly [number, number] | null;
  private readonly surface: DrawnSurface;
  private readonly normals: MovingNormals;
  private readonly skinPosition: BufferAttribute;
  private readonly skinNormal: BufferAttribute;
  private readonly tissueRest: Float32Array;
  private readonly tissueTriangles: ArrayLike<number>;
  private clipped: Plane[] = [];
  private readonly strands: RidingStrands[] = [];
  private readonly nodes = new Map<string, Object3D>();
  private readonly jawRest: Vector3;
  private readonly headRest: Vector3;
  private readonly tongue: Mesh | undefined;
  private readonly grid: number;
  private readonly maps = new FaceMaps();
  private readonly mapAddresses: Partial<Record<MapName, string>>;
  private readonly wrinkles: Wrinkles | null;
  private readonly wrinkle: BufferAttribute;
  private readonly eyes: Readonly<Record<string, EyeSetting>>;
  private readonly eyeCenters: Readonly<Record<string, Triple>>;

  /**
   * Load the tissue surface of a rig.
   * @param onProgress told the bytes that have come, and those that there are, 0 where nobody says.
   * @throws Error when the file cannot be had, or has no skin with a map.
   */
  static async load(url: string, onProgress: OnProgress = () => undefined): Promise<Face> {
    const gltf = await new GLTFLoader().loadAsync(url, ({ loaded, total, lengthComputable }) => {
      onProgress(loaded, lengthComputable ? total : 0);
    });
    return Face.build(gltf, url);
  }

  private static async build(gltf: GLTF, url: string): Promise<Face> {
    const skin = meshes(gltf.scene).find((mesh) => mesh.userData.role === 'skin');
    const extras = skin?.userData as Partial<SkinExtras> | undefined;
    if (skin === undefined || extras?.map === undefined) {
      throw new Error(
        'The surface file has no mesh with role "skin" and a map; the service is of another version.',
      );
    }
    const read = async (accessor: number): Promise<never> =>
      plainArray(
        (await gltf.parser.getDependency('accessor', accessor)) as BufferAttribute,
      ) as never;
    const { map, lids } = extras;
    const surface = new DrawnSurface(
      plainArray(skin.geometry.getAttribute('position')) as Float32Array,
      {
        indptr: await read(map.indptr),
        indices: await read(map.indices),
        weights: await read(map.weights),
        columns: map.columns,
      },
      lids === undefined || lids === null
        ? { vertices: new Uint16Array(), eyes: new Uint16Array(), clearance: new Float32Array() }
        : {
            vertices: await read(lids.vertices),
            eyes: await read(lids.eyes),
            clearance: await read(lids.clearance),
          },
      (extras.eyes ?? []).map(eyeball),
    );
    const roots = new Map<Mesh, ArrayLike<number>>();
    for (const mesh of meshes(gltf.scene)) {
      const accessor = mesh.userData.roots as number | undefined;
      if (accessor !== undefined) roots.set(mesh, await read(accessor));
    }
    const { regions, seams, wrinkles } = extras;
    return new Face(gltf, skin, {
      surface,
      roots,
      maps: mapAddresses(gltf.asset.extras, url),
      regions: regions === undefined ? null : await read(regions),
      seams: seams === undefined ? null : await read(seams),
      gauges: wrinkles === undefined || wrinkles === null ? null : await readGauges(wrinkles, read),
    });
  }

  private constructor(
    gltf: GLTF,
    skin: Mesh,
    { surface, roots, maps, regions, seams, gauges }: Skin,
  ) {
    this.mapAddresses = maps;
    this.root = gltf.scene;
    this.surface = surface;
    this.grid = (gltf.asset.extras as { grid?: number } | undefined)?.grid ?? DEFAULT_GRID;
    const extras = skin.userData as SkinExtras;
    this.landmarks = extras.landmarks ?? {};
    this.regionNames = extras.region_names ?? [];
    const tissue = meshes(this.root).find((mesh) => mesh.userData.role === 'tissue');
    this.tissueRest =
      tissue === undefined
        ? new Float32Array()
        : (plainArray(tissue.geometry.getAttribute('position')) as Float32Array);
    this.tissueTriangles = plainArray(tissue?.geometry.getIndex() ?? skin.geometry.getIndex()!);
    this.skin = skin;
    this.names = (tissue?.userData as Partial<SkinExtras> | undefined)?.names ?? extras.names ?? [];
    this.root.traverse((node) => this.nodes.set(nodeName(node), node));
    this.jawRest = this.nodes.get('jaw')?.position.clone() ?? new Vector3();
    this.headRest = this.nodes.get('head')?.position.clone() ?? new Vector3();
    this.tongue = meshes(this.root).find((mesh) => nodeName(mesh) === 'tongue');

    const index = skin.geometry.getIndex();
    if (index === null) throw new Error('The skin has no triangles.');
    this.normals = new MovingNormals(
      plainArray(index) as Uint32Array,
      surface.rest,
      plainArray(skin.geometry.getAttribute('normal')) as Float32Array,
      seams,
    );
    const restSkin = { positions: surface.rest, normals: this.normals.geometric };
    for (const [mesh, ridden] of roots) {
      const strands = new Strands(
        plainArray(mesh.geometry.getAttribute('position')) as Float32Array,
        ridden,
        restSkin,
      );
      this.strands.push({
        strands,
        attribute: dynamic(mesh.geometry, 'position', strands.positions),
      });
    }
    this.normals.update(surface.positions, surface.dirty);
    const centers = (extras.eyes ?? []).map(({ center }) => center);
    this.eyeCenters = Object.fromEntries(centers.map((center, i) => [EYE_NODES[i]!, center]));
    this.eyes = {
      'eye.L': new EyeSetting(1, this.maps.uniforms.eye),
      'eye.R': new EyeSetting(-1, this.maps.uniforms.eye),
    };
    this.neckFade = neckFadeOf(this.root);
    dress(this.root, this.maps, this.eyes, this.neckFade);
    const form = skinForm(
      {
        positions: surface.rest,
        normals: this.normals.normals,
        index: plainArray(index),
      },
      regions,
      extras.region_names ?? [],
    );
    skin.geometry.setAttribute('skinForm', new Float32BufferAttribute(form, 2));
    const walls = mouthWalls(regions, extras.region_names ?? [], form.length / 2);
    skin.geometry.setAttribute('mouthWall', new Float32BufferAttribute(walls, 1));
    this.wrinkles = gauges === null ? null : new Wrinkles(gauges);
    this.wrinkle = dynamic(
      skin.geometry,
      'wrinkle',
      this.wrinkles?.weights ?? new Float32Array(surface.rest.length / 3),
      1,
    );
    this.skinPosition = dynamic(skin.geometry, 'position', surface.positions);
    this.skinNormal = dynamic(skin.geometry, 'normal', this.normals.normals);
    this.updateEyes();
  }

  /**
   * Take on a pose, and tell whether it differs from the one before.
   * @throws Error when the pose is of another surface.
   */
  apply(pose: FacePose): boolean {
    const points = this.tissueRest.length / 3;
    if (pose.vertexCount !== points) {
      throw new Error(`The frame has ${pose.vertexCount} points, the surface ${points}.`);
    }
    const moved = this.surface.apply(pose.moved, pose.displacements, this.grid);
    if (moved) this.refreshSkin();
    const turned = [
      this.turn('head', rotation(pose.head[0], pose.head[1], pose.head[2])),
      this.turn('eye.L', rotation(pose.gaze[0], pose.gaze[1], 0)),
      this.turn('eye.R', rotation(pose.gaze[2], pose.gaze[3], 0)),
      this.turn('jaw', new Quaternion(...pose.jawQuaternion)),
      this.slide('jaw', this.jawRest, pose.jawOffset),
      this.slide('head', this.headRest, [0, 0, pose.headThrust]),
      this.putOutTongue(pose.tongueThrust),
    ];
    const changed = moved || turned.includes(true);
    if (changed) this.updateEyes();
    return changed;
  }

  /** A streamed point, by name or index, where it is drawn [mm, head frame]. */
  point(which: string | number): Triple {
    const index = typeof which === 'number' ? which : this.names.indexOf(which);
    if (!(index >= 0 && index * 3 < this.tissueRest.length))
      throw new Error(`There is no surface point "${which}".`);
    const displacement = this.surface.displacement(index);
    return displacement.map(
      (u, axis) =>
        (this.origin('tissue', axis) + this.tissueRest[index * 3 + axis]! + u) * MILLIMETRES,
    ) as Triple;
  }

  /** A vertex as it lies in the buffer that is drawn [mm, head frame]. */
  drawnVertex(index: number): Triple {
    if (!(index >= 0 && index < this.skinPosition.count))
      throw new Error(`There is no drawn vertex ${index}.`);
    return [0, 1, 2].map(
      (axis) =>
        (this.origin('skin', axis) + this.skinPosition.array[index * 3 + axis]!) * MILLIMETRES,
    ) as Triple;
  }

  /** A landmark where it is drawn [m, head frame]; null if the surface has none of that name. */
  landmarkPlace(name: string): Triple | null {
    const vertex = this.landmarks[name];
    if (vertex === undefined) return null;
    return this.drawnVertex(vertex).map((value) => value / MILLIMETRES) as Triple;
  }

  /** Have something that lies in the head's frame [m] go with the head. */
  carry(object: Object3D): void {
    const head = this.nodes.get('head');
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

  /** All streamed points at rest [mm, head frame], x y z after x y z. */
  get restPoints(): Float32Array {
    return this.tissueRest.map(
      (value, at) => (this.origin('tissue', at % 3) + value) * MILLIMETRES,
    );
  }

  /** The streamed surface: points at rest, triangles, and how far each point is from rest [m]. */
  get tissue(): { rest: Float32Array; triangles: ArrayLike<number>; moved: Float32Array } {
    return { rest: this.tissueRest, triangles: this.tissueTriangles, moved: this.surface.moved };
  }

  /** Where the drawn vertices are, at rest and now [m]. */
  get skinPlaces(): { rest: Float32Array; now: Float32Array } {
    return { rest: this.surface.rest, now: this.surface.positions };
  }

  /** Amounts at the streamed points as amounts at the drawn vertices. */
  spread(amounts: ArrayLike<number>): Float32Array {
    return this.surface.spread(amounts);
  }

  /** Where a place on a triangle of the drawn skin is at rest [mm, head frame]. */
  restOf(corners: readonly [number, number, number], weights: readonly number[]): Triple {
    return [0, 1, 2].map((axis) => {
      const at = corners.map((corner) => this.surface.rest[3 * corner + axis]!);
      const sum = at.reduce((whole, value, corner) => whole + weights[corner]! * value, 0);
      return (this.origin('skin', axis) + sum) * MILLIMETRES;
    }) as Triple;
  }

  /** Draw the skin with another material; returns its own. */
  paint(material: Material | Material[]): Material | Material[] {
    const own = this.skin.material;
    this.skin.material = material;
    this.clip(this.clipped[0] ?? null);
    return own;
  }

  /** Leave out what of skin and hair lies behind a plane of the world; null leaves out nothing. */
  clip(plane: Plane | null): void {
    this.clipped = plane === null ? [] : [plane];
    for (const mesh of meshes(this.root)) {
      const { role, material: kind } = mesh.userData as { role?: string; material?: string };
      if (mesh !== this.skin && role !== 'strands' && kind !== 'hair') continue;
      for (const material of [mesh.material].flat()) {
        if ((material.clippingPlanes?.length ?? 0) !== this.clipped.length)
          material.needsUpdate = true;
        material.clippingPlanes = this.clipped;
      }
    }
  }

  /** How far a streamed point is from rest [m]. */
  displacement(point: number): readonly [number, number, number] {
    return this.surface.displacement(point);
  }

  /** Fetch the face's maps; returns what could not be had, as one sentence. */
  loadMaps(onProgress?: OnProgress): Promise<string> {
    return this.maps.load(this.mapAddresses, onProgress);
  }

  /** Take the maps' fading in further; tells whether it has changed what is drawn. */
  stepFade(now: number, motion: boolean): boolean {
    return this.maps.step(now, motion);
  }

  get fading(): boolean {
    return this.maps.fading;
  }

  get mapsSettled(): boolean {
    return this.maps.settled;
  }

  dispose(): void {
    this.maps.dispose();
    for (const mesh of meshes(this.root)) {
      mesh.geometry.dispose();
      for (const material of [mesh.material].flat()) material.dispose();
    }
    this.root.removeFromParent();
  }

  /** Where a node's own origin lies in the head's frame at rest [m]. */
  private origin(name: string, axis: number): number {
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

  private refreshSkin(): void {
    this.normals.update(this.surface.positions, this.surface.dirty);
    this.skinPosition.needsUpdate = true;
    this.skinNormal.needsUpdate = true;
    if (this.wrinkles?.update(this.placePoint) === true) this.wrinkle.needsUpdate = true;
    for (const { strands, attribute } of this.strands) {
      strands.update({ positions: this.surface.positions, normals: this.normals.geometric });
      attribute.needsUpdate = true;
    }
  }

  /** Where a streamed point is now [m]; only differences of places are asked for. */
  private readonly placePoint = (point: number, out: Triple): void => {
    const [x, y, z] = this.surface.displacement(point);
    out[0] = this.tissueRest[point * 3]! + x;
    out[1] = this.tissueRest[point * 3 + 1]! + y;
    out[2] = this.tissueRest[point * 3 + 2]! + z;
  };

  /** Tell the eyes how they are turned, and where the lids' edges are. */
  private updateEyes(): void {
    for (const name of EYE_NODES) {
      const setting = this.eyes[name]!;
      const node = this.nodes.get(name);
      if (node !== undefined) {
        const turned = new Matrix4().makeRotationFromQuaternion(node.quaternion);
        setting.turn.value.setFromMatrix4(turned);
      }
      const center = this.eyeCenters[name];
      const side = name.slice(-1);
      const places = ['en', 'ex', 'ps', 'pi'].flatMap(
        (stem) => this.landmarks[`${stem}.${side}`] ?? [],
      );
      if (places.length < 4) continue;
      if (center === undefined) continue;
      const [inner, outer, upper, lower] = places.map((index) => {
        const place = this.drawnVertex(index);
        return place.map((at, axis) => at - center[axis]! * MILLIMETRES) as Triple;
      });
      setting.corners.value.set(inner![0], inner![1], outer![0], outer![1]);
      setting.lids.value.setX(upper![1]).setY(lower![1]);
    }
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

async function readGauges(
  accessors: Record<keyof Gauges, number>,
  read: (accessor: number) => Promise<ArrayLike<number>>,
): Promise<Gauges> {
  const { first, second, rest, gain, indptr, indices, weights } = accessors;
  return {
    first: await read(first),
    second: await read(second),
    rest: await read(rest),
    gain: await read(gain),
    indptr: await read(indptr),
    indices: await read(indices),
    weights: await read(weights),
  };
}

function eyeball(eye: NonNullable<SkinExtras['eyes']>[number]): Eyeball {
  return {
    center: eye.center,
    radius: eye.ball_radius_drawn,
    bulge: eye.bulge,
    bulgeRadius: eye.bulge_radius,
    bulgePower: eye.bulge_power ?? 1.2,
  };
}

/** Give every mesh its material, its shadow and its place in the drawing order. */
function dress(
  root: Object3D,
  maps: FaceMaps,
  eyes: Readonly<Record<string, EyeSetting>>,
  neckFade: readonly [number, number] | null,
): void {
  root.updateMatrixWorld(true);
  for (const mesh of meshes(root)) {
    const kind = (mesh.userData.material as string | undefined) ?? 'skin';
    const inMouth = (kind === 'wet' || kind === 'teeth') && isInMouth(mesh);
    if (inMouth) darkenThroat(mesh, DARKEST[kind]);
    mesh.visible = mesh.userData.role !== 'tissue';
    const { map } = mesh.material as MeshStandardMaterial;
    mesh.material = createMaterial(kind, {
      vertexColors: mesh.geometry.hasAttribute('color'),
      map,
      inMouth,
      neckFade,
      maps: mesh.geometry.hasAttribute('uv') ? maps : null,
      eye: eyeOf(mesh, eyes),
    });
    mesh.castShadow = kind !== 'cornea' && kind !== 'eye';
    mesh.receiveShadow = true;
    mesh.frustumCulled = false;
    mesh.renderOrder = DRAWN_AFTER[kind] ?? 0;
    if (kind === 'hair') addStrandAttributes(mesh);
    if (kind === 'skin') {
      const positions = mesh.geometry.getAttribute('position');
      mesh.geometry.setAttribute('restPosition', positions.clone());
    }
  }
}

/** The eye that a ball or cornea turns with. */
function eyeOf(mesh: Mesh, eyes: Readonly<Record<string, EyeSetting>>): EyeSetting | null {
  const turning = mesh.parent === null ? '' : nodeName(mesh.parent);
  return eyes[turning] ?? null;
}

function addStrandAttributes({ geometry }: Mesh<BufferGeometry>): void {
  const index = geometry.getIndex();
  if (index === null) throw new Error('Strands of hair have no triangles.');
  const positions = plainArray(geometry.getAttribute('position'));
  const triangles = plainArray(index);
  const tangents = strandTangents(positions, triangles);
  geometry.setAttribute('strandTangent', new Float32BufferAttribute(tangents, 3));
  if (geometry.hasAttribute('uv')) return; // cards are as wide as they are
  const sides = strandSides(positions, triangles);
  geometry.setAttribute('strandSide', new Float32BufferAttribute(sides, 4));
}

function isInMouth(mesh: Mesh<BufferGeometry>): boolean {
  mesh.geometry.computeBoundingSphere();
  return mesh.localToWorld(mesh.geometry.boundingSphere!.center.clone()).y < MOUTH_TOP;
}

/** Light hardly reaches the throat, and a shadow map alone does not show it. */
function darkenThroat(mesh: Mesh<BufferGeometry>, darkest: number): void {
  const positions = mesh.geometry.getAttribute('position');
  const colors = mesh.geometry.getAttribute('color') as BufferAttribute | undefined;
  if (colors === undefined) return;
  const at = new Vector3();
  for (let i = 0; i < positions.count; i++) {
    mesh.localToWorld(at.fromBufferAttribute(positions, i));
    const light = MathUtils.lerp(darkest, 1, MathUtils.smoothstep(at.z, THROAT, LIPS));
    colors.setXYZ(i, colors.getX(i) * light, colors.getY(i) * light, colors.getZ(i) * light);
  }
}

/** Heights [mm] between which skin fades above the cut of the neck; null for a mask without a neck. */
function neckFadeOf(root: Object3D): readonly [number, number] | null {
  let lowest = Infinity;
  for (const mesh of meshes(root)) {
    if (mesh.userData.material !== 'skin') continue;
    mesh.geometry.computeBoundingBox();
    lowest = Math.min(lowest, mesh.geometry.boundingBox!.min.y);
  }
  if (lowest > NECK_BELOW) return null;
  return [lowest * MILLIMETRES + NECK_END, lowest * MILLIMETRES + NECK_FADE];
}

/** Put an array in place of an attribute, for values that change from frame to frame. */
function dynamic(
  geometry: BufferGeometry,
  name: string,
  array: Float32Array,
  size = 3,
): BufferAttribute {
  const attribute = new Float32BufferAttribute(array, size);
  attribute.array = array;
  attribute.setUsage(DynamicDrawUsage);
  geometry.setAttribute(name, attribute);
  return attribute;
}

function meshes(root: Object3D): Mesh<BufferGeometry>[] {
  const found: Mesh<BufferGeometry>[] = [];
  root.traverse((node) => {
    if (node instanceof Mesh) found.push(node as Mesh<BufferGeometry>);
  });
  return found;
}

/** The loader takes dots out of names and keeps the original beside it. */
function nodeName(node: Object3D): string {
  return (node.userData.name as string | undefined) ?? node.name;
}

function plainArray(attribute: BufferAttribute | InterleavedBufferAttribute): ArrayLike<number> {
  if (!('isInterleavedBufferAttribute' in attribute)) return attribute.array;
  const out = new Float32Array(attribute.count * attribute.itemSize);
  for (let i = 0; i < out.length; i++) {
    out[i] = attribute.getComponent(Math.floor(i / attribute.itemSize), i % attribute.itemSize);
  }
  return out;
}
