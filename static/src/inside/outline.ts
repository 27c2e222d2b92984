// Where a sheet of tissue ends on the head: its outer border, and how far inside it a place of the skin lies.

import type { Point } from '../vector';
import { minus } from '../vector';

/** A border: places along it, the last joined to the first. */
export type Ring = readonly Point[];

/** Where a sheet ends, and a place well inside it. */
export interface Outline {
  ring: Ring;
  middle: Point;
}

/** A mesh: x y z after x y z, and corners of its triangles. */
export interface Sheet {
  positions: ArrayLike<number>;
  triangles: ArrayLike<number>;
}

/** Points of the longest border of a sheet, in order: round the face, not round an eye. */
export function outline({ positions, triangles }: Sheet): number[] {
  const next = new Map<number, number>();
  for (const [from, to] of bordersOf(triangles)) next.set(from, to);
  let longest: number[] = [];
  let most = -1;
  while (next.size > 0) {
    const loop: number[] = [];
    for (let at = next.keys().next().value!; next.has(at);) {
      loop.push(at);
      const to = next.get(at)!;
      next.delete(at);
      at = to;
    }
    const length = loop.reduce((sum, point, at) => {
      const way = minus(
        placeOf(positions, loop[(at + 1) % loop.length]!),
        placeOf(positions, point),
      );
      return sum + Math.hypot(...way);
    }, 0);
    if (length > most) [longest, most] = [loop, length];
  }
  return longest;
}

/** Edges that one triangle alone has, as it goes round. */
function bordersOf(triangles: ArrayLike<number>): [number, number][] {
  const edges = new Map<string, [number, number]>();
  eachEdge(triangles, (from, to) => {
    if (!edges.delete(`${to} ${from}`)) edges.set(`${from} ${to}`, [from, to]);
  });
  return [...edges.values()];
}

/** How far each place is from a border, in the border's units. */
export function farFrom(ring: Ring, positions: ArrayLike<number>): Float32Array {
  return Float32Array.from({ length: positions.length / 3 }, (_, at) =>
    distance(ring, placeOf(positions, at)),
  );
}

/**
 * How far inside a border each vertex of a skin lies that goes on beyond it; negative outside.
 *
 * The border runs along the skin, and parts it: what is reached from its middle without stepping over it is inside.
 * @param same first of the vertices that lie at the same place, for each; null where there are none.
 */
export function insideOf(
  { ring, middle }: Outline,
  skin: Sheet,
  same: ArrayLike<number> | null,
): Float32Array {
  const count = skin.positions.length / 3;
  const inside = farFrom(ring, skin.positions).map((far) => -far);
  const first = (at: number): number => same?.[at] ?? at;
  const edges = new Edges(skin, first);
  const corners = ring.map((point) => first(nearestTo(point, skin.positions)));
  const open = new Uint8Array(count).fill(1);
  corners.forEach((corner, at) => {
    for (const vertex of edges.way(corner, corners[(at + 1) % corners.length]!)) open[vertex] = 0;
  });
  for (let at = 0; at < count; at++) {
    open[at] = open[first(at)]!;
    if (open[at] === 0) inside[at] = 0;
  }
  const group = joined(skin.triangles, open, first);
  let [reached, least] = [-1, Infinity];
  for (let at = 0; at < count; at++) {
    const far = Math.hypot(...minus(placeOf(skin.positions, at), middle));
    if (open[at] === 1 && far < least) [reached, least] = [group[at]!, far];
  }
  for (let at = 0; at < count; at++)
    if (open[at] === 1 && group[at] === reached) inside[at] = -inside[at]!;
  return inside;
}

/** Ways along the edges of a mesh. */
class Edges {
  private readonly beside: number[][];

  /** @param first of the vertices that lie where a vertex does. */
  constructor(
    private readonly mesh: Sheet,
    first: (at: number) => number,
  ) {
    this.beside = Array.from({ length: mesh.positions.length / 3 }, () => []);
    eachEdge(mesh.triangles, (from, to) => {
      this.beside[first(from)]!.push(first(to));
      this.beside[first(to)]!.push(first(from));
    });
  }

  /** Vertices of the shortest way from one to another, both among them (Dijkstra's algorithm). */
  way(from: number, to: number): number[] {
    const reached = new Map([[from, { far: 0, before: -1, done: false }]]);
    for (;;) {
      let [at, least] = [-1, Infinity];
      for (const [vertex, { far, done }] of reached)
        if (!done && far < least) [at, least] = [vertex, far];
      if (at === -1 || at === to) break;
      reached.get(at)!.done = true;
      for (const next of this.beside[at]!) {
        const far = least + this.length(at, next);
        if (far < (reached.get(next)?.far ?? Infinity))
          reached.set(next, { far, before: at, done: false });
      }
    }
    const found: number[] = [];
    for (let at = to; at !== -1; at = reached.get(at)?.before ?? -1) found.push(at);
    return found;
  }

  private length(from: number, to: number): number {
    const { positions } = this.mesh;
    return Math.hypot(...minus(placeOf(positions, from), placeOf(positions, to)));
  }
}

function eachEdge(triangles: ArrayLike<number>, told: (from: number, to: number) => void): void {
  for (let at = 0; at < triangles.length; at++)
    told(triangles[at]!, triangles[at % 3 === 2 ? at - 2 : at + 1]!);
}

/** A number for each vertex, the same for those that edges between open vertices join. */
function joined(
  triangles: ArrayLike<number>,
  open: Uint8Array,
  first: (at: number) => number,
): Int32Array {
  const parent = Int32Array.from(open, (_, at) => first(at));
  const root = (at: number): number => {
    while (parent[at] !== at) at = parent[at] = parent[parent[at]!]!;
    return at;
  };
  eachEdge(triangles, (from, to) => {
    if (open[from] === 1 && open[to] === 1) parent[root(from)] = root(to);
  });
  return parent.map((_, at) => root(at));
}

function nearestTo(point: Point, positions: ArrayLike<number>): number {
  let [found, least] = [0, Infinity];
  for (let at = 0; at < positions.length / 3; at++) {
    const far = Math.hypot(...minus(placeOf(positions, at), point));
    if (far < least) [found, least] = [at, far];
  }
  return found;
}

/** How far a place is from a border. */
function distance(ring: Ring, [x, y, z]: Point): number {
  let far = Infinity;
  for (let at = 0; at < ring.length; at++) {
    const [from, to] = [ring[at]!, ring[(at + 1) % ring.length]!];
    const [ax, ay, az] = [x - from[0], y - from[1], z - from[2]];
    const [bx, by, bz] = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
    const square = bx * bx + by * by + bz * bz;
    const along = Math.min(1, Math.max(0, (ax * bx + ay * by + az * bz) / square));
    far = Math.min(far, Math.hypot(ax - along * bx, ay - along * by, az - along * bz));
  }
  return far;
}

function placeOf(positions: ArrayLike<number>, at: number): Point {
  return [positions[3 * at]!, positions[3 * at + 1]!, positions[3 * at + 2]!];
}
