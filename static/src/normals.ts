// Vertex normals of a surface that moves in places: only what moved is computed again.

/** Of each vertex, the triangles around it. */
interface Fans {
  pointers: Uint32Array;
  triangles: Uint32Array;
}

export class MovingNormals {
  /** Normals to draw with, x y z after x y z: at rest the authored ones. */
  readonly normals: Float32Array;
  /** Area-weighted unit normals of the triangles, which strands turn with. */
  readonly geometric: Float32Array;
  /** Of each vertex, the first that lies at its place: where maps are cut, vertices are doubled. */
  private readonly first: Uint32Array;
  private readonly doubles: Uint32Array;
  /** Of first vertices, with the triangles of their doubles. */
  private readonly fans: Fans;
  /** Area-weighted normal of each triangle. */
  private readonly faces: Float32Array;
  /** What the authored rest normals add to the ones computed here, so that rest looks as authored. */
  private readonly authored: Float32Array;
  private readonly dirtyTriangle: Uint8Array;
  private readonly dirtyVertex: Uint8Array;

  constructor(
    private readonly index: Uint32Array | Uint16Array,
    rest: Float32Array,
    restNormals: Float32Array,
    seams: ArrayLike<number> | null = null,
  ) {
    const vertices = rest.length / 3;
    this.first = Uint32Array.from({ length: vertices }, (_, i) => seams?.[i] ?? i);
    this.doubles = Uint32Array.from(this.first.keys()).filter((i) => this.first[i] !== i);
    this.fans = fansOf(
      index.map((vertex) => this.first[vertex]!),
      vertices,
    );
    this.faces = new Float32Array(index.length);
    this.dirtyTriangle = new Uint8Array(index.length / 3).fill(1);
    this.dirtyVertex = new Uint8Array(vertices).fill(1);
    this.normals = new Float32Array(rest.length);
    this.geometric = new Float32Array(rest.length);
    this.authored = new Float32Array(rest.length);
    this.refresh(rest);
    for (let i = 0; i < rest.length; i++) this.authored[i] = restNormals[i]! - this.geometric[i]!;
    this.normals.set(restNormals);
  }

  /** Bring the normals around the `moved` vertices (1 = moved) up to date with `positions`. */
  update(positions: Float32Array, moved: Uint8Array): void {
    this.mark(moved);
    this.refresh(positions);
  }

  private mark(moved: Uint8Array): void {
    this.dirtyTriangle.fill(0);
    this.dirtyVertex.fill(0);
    const { pointers, triangles } = this.fans;
    for (let vertex = 0; vertex < moved.length; vertex++) {
      if (moved[vertex] === 0) continue;
      const first = this.first[vertex]!;
      const end = pointers[first + 1]!;
      for (let k = pointers[first]!; k < end; k++) {
        const triangle = triangles[k]!;
        if (this.dirtyTriangle[triangle] !== 0) continue;
        this.dirtyTriangle[triangle] = 1;
        for (let c = 0; c < 3; c++) {
          this.dirtyVertex[this.first[this.index[triangle * 3 + c]!]!] = 1;
        }
      }
    }
  }

  private refresh(positions: Float32Array): void {
    for (let triangle = 0; triangle < this.dirtyTriangle.length; triangle++) {
      if (this.dirtyTriangle[triangle] !== 0) this.updateFace(positions, triangle * 3);
    }
    for (let vertex = 0; vertex < this.dirtyVertex.length; vertex++) {
      if (this.dirtyVertex[vertex] !== 0) this.updateVertex(vertex);
    }
    for (const double of this.doubles) {
      const first = this.first[double]!;
      if (this.dirtyVertex[first] === 0) continue;
      this.geometric.copyWithin(double * 3, first * 3, first * 3 + 3);
      this.normals.copyWithin(double * 3, first * 3, first * 3 + 3);
    }
  }

  private updateFace(p: Float32Array, at: number): void {
    const a = this.index[at]! * 3;
    const b = this.index[at + 1]! * 3;
    const c = this.index[at + 2]! * 3;
    const ux = p[b]! - p[a]!;
    const uy = p[b + 1]! - p[a + 1]!;
    const uz = p[b + 2]! - p[a + 2]!;
    const vx = p[c]! - p[a]!;
    const vy = p[c + 1]! - p[a + 1]!;
    const vz = p[c + 2]! - p[a + 2]!;
    this.faces[at] = uy * vz - uz * vy;
    this.faces[at + 1] = uz * vx - ux * vz;
    this.faces[at + 2] = ux * vy - uy * vx;
  }

  private updateVertex(vertex: number): void {
    const { pointers, triangles } = this.fans;
    let x = 0;
    let y = 0;
    let z = 0;
    const end = pointers[vertex + 1]!;
    for (let k = pointers[vertex]!; k < end; k++) {
      const at = triangles[k]! * 3;
      x += this.faces[at]!;
      y += this.faces[at + 1]!;
      z += this.faces[at + 2]!;
    }
    const at = vertex * 3;
    const scale = 1 / (Math.sqrt(x * x + y * y + z * z) || 1);
    x = this.geometric[at] = x * scale;
    y = this.geometric[at + 1] = y * scale;
    z = this.geometric[at + 2] = z * scale;
    x += this.authored[at]!;
    y += this.authored[at + 1]!;
    z += this.authored[at + 2]!;
    const unit = 1 / (Math.sqrt(x * x + y * y + z * z) || 1);
    this.normals[at] = x * unit;
    this.normals[at + 1] = y * unit;
    this.normals[at + 2] = z * unit;
  }
}

function fansOf(index: Uint32Array | Uint16Array, vertices: number): Fans {
  const pointers = new Uint32Array(vertices + 1);
  for (const vertex of index) pointers[vertex + 1]!++;
  for (let vertex = 0; vertex < vertices; vertex++) pointers[vertex + 1]! += pointers[vertex]!;
  const next = pointers.slice();
  const triangles = new Uint32Array(index.length);
  index.forEach((vertex, at) => (triangles[next[vertex]!++] = Math.floor(at / 3)));
  return { pointers, triangles };
}
