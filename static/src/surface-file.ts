// surface.glb read: the head's meshes, the map from streamed points to drawn skin, and what the skin needs besides.

import type { BufferAttribute, Group, Mesh } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { meshes, plainArray } from './gltf-nodes';
import { refusalOf } from './refusal';
import type { Eyeball } from './surface';
import { DrawnSurface } from './surface';
import type { MapName } from './textures';
import { mapAddresses } from './textures';
import type { Gauges } from './wrinkles';

export interface SkinExtras {
  map: { indptr: number; indices: number; weights: number; columns: number };
  lids?: { vertices: number; eyes: number; clearance: number } | null;
  eyes?: {
    center: readonly [number, number, number];
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

/** What a surface file holds. */
export interface SurfaceFile {
  scene: Group;
  /** Length of a step of frames [m]. */
  grid: number;
  skin: Mesh;
  extras: SkinExtras;
  surface: DrawnSurface;
  /** The drawn vertices that strands ride on. */
  roots: Map<Mesh, ArrayLike<number>>;
  maps: Partial<Record<MapName, string>>;
  regions: ArrayLike<number> | null;
  /** First of the vertices that lie at the same place, for each. */
  seams: ArrayLike<number> | null;
  gauges: Gauges | null;
}

/** Told how much is done, out of how much. */
export type OnProgress = (done: number, total: number) => void;

const DEFAULT_GRID = 2e-5;

/**
 * Load the tissue surface of a rig.
 * @param onProgress told the bytes that have come, and those that there are, 0 where nobody says.
 * @throws ApiError when the service refuses the file.
 * @throws Error when the file cannot be had, or has no skin with a map.
 */
export async function readSurface(url: string, onProgress: OnProgress): Promise<SurfaceFile> {
  const gltf = await new GLTFLoader()
    .loadAsync(url, ({ loaded, total, lengthComputable }) => {
      onProgress(loaded, lengthComputable ? total : 0);
    })
    .catch(async (error: unknown) => {
      // The loader's own words would name the address, which may carry a ticket.
      const { response } = error as { response?: unknown };
      throw response instanceof Response ? await refusalOf(response) : error;
    });
  const skin = meshes(gltf.scene).find((mesh) => mesh.userData.role === 'skin');
  const extras = skin?.userData as Partial<SkinExtras> | undefined;
  if (skin === undefined || extras?.map === undefined) {
    throw new Error(
      'The surface file has no mesh with role "skin" and a map; the service is of another version.',
    );
  }
  const read = async (accessor: number): Promise<never> =>
    plainArray((await gltf.parser.getDependency('accessor', accessor)) as BufferAttribute) as never;
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
  return {
    scene: gltf.scene,
    grid: (gltf.asset.extras as { grid?: number } | undefined)?.grid ?? DEFAULT_GRID,
    skin,
    extras: extras as SkinExtras,
    surface,
    roots,
    maps: mapAddresses(gltf.asset.extras, url),
    regions: regions === undefined ? null : await read(regions),
    seams: seams === undefined ? null : await read(seams),
    gauges: wrinkles === undefined || wrinkles === null ? null : await readGauges(wrinkles, read),
  };
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
