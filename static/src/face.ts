// The face as three.js draws it: surface.glb in, poses of the tissue surface applied.

import type { BufferAttribute, Group, Material, Mesh, Object3D } from 'three';
import { Float32BufferAttribute } from 'three';
import { dress, neckFadeOf } from './dressing';
import { FaceEyes } from './face-eyes';
import { FaceNodes } from './face-nodes';
import { FRINGE } from './fringe';
import { dynamic, meshes, plainArray } from './gltf-nodes';
import { MovingNormals } from './normals';
import type { Peelable } from './peel';
import { NOTHING_PEELED } from './peel';
import type { FacePose, Triple } from './pose';
import type { JawPose } from './riding';
import { mouthWalls, skinForm } from './skin-form';
import { Strands } from './strands';
import type { DrawnSurface } from './surface';
import type { OnProgress, SkinExtras, SurfaceFile } from './surface-file';
import { readSurface } from './surface-file';
import type { MapName } from './textures';
import { FaceMaps } from './textures';
import { Wrinkles } from './wrinkles';

interface RidingStrands {
  strands: Strands;
  attribute: BufferAttribute;
}

const MILLIMETRES = 1000;

export class Face {
  readonly root: Group;
  readonly landmarks: Readonly<Record<string, number>>;
  readonly names: readonly string[];
  /** Labels of the regions of its skin. */
  readonly regionNames: readonly string[];
  readonly skin: Mesh;
  /** Heights between which the neck fades into the ground [mm]; null for a mask without a neck. */
  readonly neckFade: readonly [number, number] | null;
  /** Skin of it further to the left than this is left out, as far as there is tissue under it [m]; see peel.ts. */
  readonly peelCut = { value: NOTHING_PEELED };
  private readonly surface: DrawnSurface;
  private readonly normals: MovingNormals;
  private readonly skinPosition: BufferAttribute;
  private readonly skinNormal: BufferAttribute;
  private readonly tissueRest: Float32Array;
  private readonly tissueTriangles: ArrayLike<number>;
  private readonly roots: SurfaceFile['roots'];
  private readonly seams: SurfaceFile['seams'];
  private readonly strands: RidingStrands[] = [];
  private readonly nodes: FaceNodes;
  private readonly grid: number;
  private readonly maps = new FaceMaps();
  private readonly mapAddresses: Partial<Record<MapName, string>>;
  private readonly wrinkles: Wrinkles | null;
  private readonly wrinkle: BufferAttribute;
  private readonly eyes: FaceEyes;

  /**
   * Load the tissue surface of a rig; see `readSurface`.
   * @throws Error when the file cannot be had, or has no skin with a map.
   */
  static async load(url: string, onProgress: OnProgress = () => undefined): Promise<Face> {
    return new Face(await readSurface(url, onProgress));
  }

  private constructor(file: SurfaceFile) {
    const { scene, grid, skin, extras, surface, roots, maps, regions, seams, gauges } = file;
    this.mapAddresses = maps;
    this.root = scene;
    [this.roots, this.seams] = [roots, seams];
    this.surface = surface;
    this.grid = grid;
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
    this.nodes = new FaceNodes(this.root);

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
    this.eyes = new FaceEyes(centers, this.maps.uniforms.eye);
    this.neckFade = neckFadeOf(this.root);
    dress(this.root, this.maps, this.eyes.settings, this);
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
    this.turnEyes();
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
    const turned = this.nodes.apply(pose);
    const changed = moved || turned;
    if (changed) this.turnEyes();
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
        (this.nodes.origin('tissue', axis) + this.tissueRest[index * 3 + axis]! + u) * MILLIMETRES,
    ) as Triple;
  }

  /** A vertex as it lies in the buffer that is drawn [mm, head frame]. */
  drawnVertex(index: number): Triple {
    if (!(index >= 0 && index < this.skinPosition.count))
      throw new Error(`There is no drawn vertex ${index}.`);
    return [0, 1, 2].map(
      (axis) =>
        (this.nodes.origin('skin', axis) + this.skinPosition.array[index * 3 + axis]!) *
        MILLIMETRES,
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
    this.nodes.carry(object);
  }

  /** The jaw as it stands. */
  get jaw(): JawPose {
    return this.nodes.jaw;
  }

  /** All streamed points at rest [mm, head frame], x y z after x y z. */
  get restPoints(): Float32Array {
    return this.tissueRest.map(
      (value, at) => (this.nodes.origin('tissue', at % 3) + value) * MILLIMETRES,
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
      return (this.nodes.origin('skin', axis) + sum) * MILLIMETRES;
    }) as Triple;
  }

  /** Draw the skin with another material; returns its own. */
  paint(material: Material | Material[]): Material | Material[] {
    const own = this.skin.material;
    this.skin.material = material;
    return own;
  }

  /** What can be peeled off it. */
  get peelable(): Peelable {
    const origin = [0, 1, 2].map((axis) => this.nodes.origin('skin', axis));
    const hair = meshes(this.root).filter(
      ({ userData: { material, role } }) =>
        material !== FRINGE && (material === 'hair' || role === 'strands'),
    );
    return {
      skin: this.skin.geometry,
      positions: this.surface.rest.map((value, at) => origin[at % 3]! + value),
      seams: this.seams,
      hair: hair.map((mesh) => ({ geometry: mesh.geometry, roots: this.roots.get(mesh) ?? null })),
    };
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
  private turnEyes(): void {
    this.eyes.update(this.nodes, this.landmarks, (vertex) => this.drawnVertex(vertex));
  }
}
