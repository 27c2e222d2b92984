// Brows and lashes: each strand vertex rides the skin vertex at its root.

/** What the strands ride; x y z after x y z. */
export interface Skin {
  positions: Float32Array;
  normals: Float32Array;
}

/**
 * Move strand vertices with their roots: x = V[root] + R (x0 - V0[root]), where R is the smallest rotation that takes
 * the root's rest normal to its present one.
 */
export class Strands {
  readonly positions: Float32Array;
  private readonly offsets: Float32Array;
  private readonly restNormals: Float32Array;

  constructor(
    rest: Float32Array,
    private readonly roots: ArrayLike<number>,
    skin: Skin,
  ) {
    this.positions = rest.slice();
    this.offsets = new Float32Array(rest.length);
    this.restNormals = new Float32Array(rest.length);
    for (let i = 0; i < rest.length; i++) {
      const at = roots[Math.floor(i / 3)]! * 3 + (i % 3);
      this.offsets[i] = rest[i]! - skin.positions[at]!;
      this.restNormals[i] = skin.normals[at]!;
    }
  }

  update(skin: Skin): void {
    for (let vertex = 0; vertex < this.roots.length; vertex++) {
      this.ride(vertex * 3, this.roots[vertex]! * 3, skin);
    }
  }

  /** Rodrigues' formula for the rotation a -> b, written without its angle: axis a x b, cosine a . b. */
  private ride(at: number, root: number, { positions, normals }: Skin): void {
    const ax = this.restNormals[at]!;
    const ay = this.restNormals[at + 1]!;
    const az = this.restNormals[at + 2]!;
    const bx = normals[root]!;
    const by = normals[root + 1]!;
    const bz = normals[root + 2]!;
    const rx = this.offsets[at]!;
    const ry = this.offsets[at + 1]!;
    const rz = this.offsets[at + 2]!;
    const cx = ay * bz - az * by;
    const cy = az * bx - ax * bz;
    const cz = ax * by - ay * bx;
    const cosine = ax * bx + ay * by + az * bz;
    const along = (cx * rx + cy * ry + cz * rz) / Math.max(1 + cosine, 0.05);
    this.positions[at] = positions[root]! + rx * cosine + cy * rz - cz * ry + cx * along;
    this.positions[at + 1] = positions[root + 1]! + ry * cosine + cz * rx - cx * rz + cy * along;
    this.positions[at + 2] = positions[root + 2]! + rz * cosine + cx * ry - cy * rx + cz * along;
  }
}
