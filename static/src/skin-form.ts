// The form of resting skin that its light depends on: how sharply it bends, and where it is thin.

/** Skin that light shines through from behind, 0..1, by region of the surface. */
const THIN: Record<string, number> = { ear: 0.8, ala: 0.22, nostril: 0.2, columella: 0.15 };
/** Curvature below which skin covers something thick, and above which it is an edge [1/mm]. */
const FLAT = 0.03;
const SHARP = 0.14;
/** Rounds of averaging: light blurs what is narrower than some millimetres anyway. */
const ROUNDS = 3;
/** Above this [1/mm], e.g. on the rim of a lid, light can hardly reach farther round. */
const SHARPEST = 0.25;

/** A surface: x y z after x y z [m], and corners of its triangles. */
export interface Surface {
  positions: ArrayLike<number>;
  normals: ArrayLike<number>;
  index: ArrayLike<number>;
}

/**
 * Mean curvature [1/mm], positive where convex, and thinness of each vertex: two numbers after two numbers.
 * @param regionOf region of each vertex, an index into `regionNames`; null if the surface has none.
 */
export function skinForm(
  surface: Surface,
  regionOf: ArrayLike<number> | null,
  regionNames: readonly string[],
): Float32Array {
  const count = surface.positions.length / 3;
  const edges = edgesOf(surface.index);
  const form = new Float32Array(count * 2);
  const degree = new Float32Array(count);
  for (let e = 0; e < edges.length; e += 2) {
    const [a, b] = [edges[e]!, edges[e + 1]!];
    const bend = bendAlong(surface, a, b);
    for (const vertex of [a, b]) {
      form[vertex * 2]! += bend;
      degree[vertex]!++;
    }
  }
  for (let vertex = 0; vertex < count; vertex++) {
    form[vertex * 2]! /= Math.max(1, degree[vertex]!);
    const region = regionOf === null ? '' : (regionNames[regionOf[vertex]!] ?? '');
    form[vertex * 2 + 1] = (THIN[region] ?? 0) * edgeShare(form[vertex * 2]!);
  }
  for (let round = 0; round < ROUNDS; round++) average(form, edges, degree);
  return form;
}

/** 1 on the walls of the mouth behind the lips, 0 elsewhere: a number for each vertex. */
export function mouthWalls(
  regionOf: ArrayLike<number> | null,
  regionNames: readonly string[],
  count: number,
): Float32Array {
  const wall = regionNames.indexOf('mouth_inner');
  const walls = new Float32Array(count);
  if (regionOf !== null && wall >= 0)
    for (let vertex = 0; vertex < count; vertex++)
      walls[vertex] = Number(regionOf[vertex] === wall);
  return walls;
}

/** Thin skin bulges: an ear's rim and folds do, the skin around the ear and its furrow before it do not. */
function edgeShare(bend: number): number {
  return Math.min(1, Math.max(0, (bend - FLAT) / (SHARP - FLAT)));
}

/** How much the normal turns along an edge [1/mm]. */
function bendAlong({ positions, normals }: Surface, a: number, b: number): number {
  let turned = 0;
  let squared = 0;
  for (let axis = 0; axis < 3; axis++) {
    const along = positions[b * 3 + axis]! - positions[a * 3 + axis]!;
    turned += (normals[b * 3 + axis]! - normals[a * 3 + axis]!) * along;
    squared += along * along;
  }
  const bend = turned / Math.max(squared, 1e-12) / 1000;
  return Math.min(SHARPEST, Math.max(-SHARPEST, bend));
}

/** Each edge of the triangles, once or twice: how often does not matter to an average. */
function edgesOf(index: ArrayLike<number>): Uint32Array {
  const edges = new Uint32Array(index.length * 2);
  for (let corner = 0; corner < index.length; corner++) {
    edges[corner * 2] = index[corner]!;
    edges[corner * 2 + 1] = index[corner % 3 === 2 ? corner - 2 : corner + 1]!;
  }
  return edges;
}

/** Halfway to the mean of the neighbours. */
function average(form: Float32Array, edges: Uint32Array, degree: Float32Array): void {
  const sums = new Float32Array(form.length);
  for (let e = 0; e < edges.length; e += 2) {
    const [a, b] = [edges[e]! * 2, edges[e + 1]! * 2];
    for (let k = 0; k < 2; k++) {
      sums[a + k]! += form[b + k]!;
      sums[b + k]! += form[a + k]!;
    }
  }
  for (let i = 0; i < form.length; i++) {
    form[i] = 0.5 * form[i]! + (0.5 * sums[i]!) / Math.max(1, degree[i >> 1]!);
  }
}
