// Moves the drawn surface: the sparse map from tissue displacements, and lids that slide over the eyeballs.

/** Rows of drawn vertices, columns of streamed points: u_drawn[i] = sum of weights[k] * u[indices[k]]. */
export interface SparseMap {
  /** (d + 1,) */
  indptr: Uint32Array;
  indices: Uint32Array | Uint16Array;
  weights: Float32Array;
  /** Number of streamed points. */
  columns: number;
}

/** An eyeball as the lids meet it; all in metres. */
export interface Eyeball {
  center: readonly [number, number, number];
  /** Height of the corneal bulge over the ball. */
  bulge: number;
  bulgeRadius: number;
  /** The bulge falls as (1 - (rho / bulgeRadius)^2)^bulgePower from its pole. */
  bulgePower: number;
  /** Radius of the ball as drawn. */
  radius: number;
}

/** Drawn vertices that may not enter an eyeball. */
export interface LidContact {
  vertices: Uint32Array | Uint16Array;
  /** 0 left, 1 right, per vertex. */
  eyes: Uint16Array | Uint8Array;
  /** Distance kept from the ball per vertex [m]. */
  clearance: Float32Array;
}

export class DrawnSurface {
  /** Current positions, x y z after x y z [m]. */
  readonly positions: Float32Array;
  /** 1 for each drawn vertex that the last `apply` moved. */
  readonly dirty: Uint8Array;
  private readonly displacements: Float32Array;
  private readonly columnPointers: Uint32Array;
  private readonly columnRows: Uint32Array;
  private readonly lidOfVertex: Int32Array;

  constructor(
    readonly rest: Float32Array,
    private readonly map: SparseMap,
    private readonly lids: LidContact,
    private readonly eyes: readonly Eyeball[],
  ) {
    this.positions = rest.slice();
    this.dirty = new Uint8Array(rest.length / 3);
    this.displacements = new Float32Array(map.columns * 3);
    [this.columnPointers, this.columnRows] = transpose(map);
    this.lidOfVertex = new Int32Array(rest.length / 3).fill(-1);
    lids.vertices.forEach((vertex, index) => (this.lidOfVertex[vertex] = index));
    this.dirty.fill(1);
    for (let row = 0; row < this.dirty.length; row++) this.updateRow(row);
  }

  /**
   * Set the streamed points' displacements; points that are not named are at rest.
   * @param moved indices of displaced points.
   * @param steps three grid steps per moved point.
   * @param grid length of a step [m].
   * @returns whether any drawn vertex moved; `dirty` says which.
   */
  apply(moved: ArrayLike<number>, steps: ArrayLike<number>, grid: number): boolean {
    this.dirty.fill(0);
    const next = new Float32Array(this.displacements.length);
    for (let m = 0; m < moved.length; m++) {
      const at = moved[m]! * 3;
      next[at] = steps[m * 3]! * grid;
      next[at + 1] = steps[m * 3 + 1]! * grid;
      next[at + 2] = steps[m * 3 + 2]! * grid;
    }
    let changed = false;
    for (let point = 0; point < this.map.columns; point++) {
      if (this.takePoint(point, next)) changed = true;
    }
    if (!changed) return false;
    for (let row = 0; row < this.dirty.length; row++)
      if (this.dirty[row] !== 0) this.updateRow(row);
    return true;
  }

  /** Displacements of all streamed points as last applied [m], x y z after x y z; not to be changed. */
  get moved(): Float32Array {
    return this.displacements;
  }

  /** Amounts at the streamed points, spread over the drawn vertices as displacements are. */
  spread(amounts: ArrayLike<number>): Float32Array {
    const { indptr, indices, weights } = this.map;
    const spread = new Float32Array(indptr.length - 1);
    for (let row = 0; row < spread.length; row++) {
      for (let k = indptr[row]!; k < indptr[row + 1]!; k++) {
        spread[row]! += weights[k]! * amounts[indices[k]!]!;
      }
    }
    return spread;
  }

  /** Displacement of a streamed point as last applied [m]. */
  displacement(point: number): [number, number, number] {
    const u = this.displacements;
    return [u[point * 3]!, u[point * 3 + 1]!, u[point * 3 + 2]!];
  }

  private takePoint(point: number, next: Float32Array): boolean {
    const u = this.displacements;
    const at = point * 3;
    if (u[at] === next[at] && u[at + 1] === next[at + 1] && u[at + 2] === next[at + 2])
      return false;
    u[at] = next[at]!;
    u[at + 1] = next[at + 1]!;
    u[at + 2] = next[at + 2]!;
    const end = this.columnPointers[point + 1]!;
    for (let k = this.columnPointers[point]!; k < end; k++) this.dirty[this.columnRows[k]!] = 1;
    return true;
  }

  private updateRow(row: number): void {
    const { indptr, indices, weights } = this.map;
    const u = this.displacements;
    let x = this.rest[row * 3]!;
    let y = this.rest[row * 3 + 1]!;
    let z = this.rest[row * 3 + 2]!;
    const end = indptr[row + 1]!;
    for (let k = indptr[row]!; k < end; k++) {
      const weight = weights[k]!;
      const column = indices[k]! * 3;
      x += weight * u[column]!;
      y += weight * u[column + 1]!;
      z += weight * u[column + 2]!;
    }
    this.positions[row * 3] = x;
    this.positions[row * 3 + 1] = y;
    this.positions[row * 3 + 2] = z;
    const lid = this.lidOfVertex[row]!;
    if (lid >= 0) this.liftLid(row, this.eyes[this.lids.eyes[lid]!], this.lids.clearance[lid]!);
  }

  /** Push a lid vertex out of the ball along the ray from the ball's centre. */
  private liftLid(row: number, eye: Eyeball | undefined, clearance: number): void {
    if (eye === undefined) return;
    const p = this.positions;
    const dx = p[row * 3]! - eye.center[0];
    const dy = p[row * 3 + 1]! - eye.center[1];
    const dz = p[row * 3 + 2]! - eye.center[2];
    if (dz <= 0) return;
    const share = Math.max(0, 1 - (dx * dx + dy * dy) / (eye.bulgeRadius * eye.bulgeRadius));
    const nearest = eye.radius + eye.bulge * share ** eye.bulgePower + clearance;
    const distance = Math.hypot(dx, dy, dz);
    if (distance >= nearest) return;
    const scale = nearest / distance;
    p[row * 3] = eye.center[0] + dx * scale;
    p[row * 3 + 1] = eye.center[1] + dy * scale;
    p[row * 3 + 2] = eye.center[2] + dz * scale;
  }
}

/** Which rows use each column: (pointers (columns + 1,), rows). */
function transpose(map: SparseMap): [Uint32Array, Uint32Array] {
  const pointers = new Uint32Array(map.columns + 1);
  for (const column of map.indices) pointers[column + 1]!++;
  for (let column = 0; column < map.columns; column++) pointers[column + 1]! += pointers[column]!;
  const next = pointers.slice();
  const rows = new Uint32Array(map.indices.length);
  for (let row = 0; row + 1 < map.indptr.length; row++) {
    for (let k = map.indptr[row]!; k < map.indptr[row + 1]!; k++) {
      rows[next[map.indices[k]!]!++] = row;
    }
  }
  return [pointers, rows];
}
