// Where peeled layers end, their section: a band for each, along the cut through the face and along the sheets' border.

import {
  BufferGeometry,
  DoubleSide,
  DynamicDrawUsage,
  Float32BufferAttribute,
  Mesh,
  ShaderMaterial,
  Color,
} from 'three';

/** A place of the section on every sheet: this share of the way from one of the sheet's points to another. */
interface Post {
  from: number;
  to: number;
  share: number;
}

type Piece = readonly [Post, Post];

export class Section {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
  private readonly border: Piece[];
  /** What the bands go along: the cut, and of the border what lies beyond that. */
  private pieces: Piece[] = [];
  private at = NaN;
  private sheets = 0;

  /**
   * @param across how far to the face's left each point of a sheet is at rest.
   * @param ring the sheets' border, in order.
   * @param colors of the bands, outermost first.
   */
  constructor(
    private readonly across: ArrayLike<number>,
    private readonly triangles: ArrayLike<number>,
    ring: readonly number[],
    private readonly colors: readonly string[],
  ) {
    this.border = ring.map((from, at) => [post(from), post(ring[(at + 1) % ring.length]!)]);
    this.mesh = new Mesh(new BufferGeometry(), createSection());
    this.mesh.frustumCulled = false;
  }

  /** Show the bands over the sheet of this number, cut where the points are this far to the left; no sheet, no bands. */
  show(sheets: number, cut: number): void {
    if (cut === this.at && sheets === this.sheets) return;
    this.pieces = [
      ...cutOf(this.triangles, this.across, cut),
      ...this.border.flatMap((piece) => beyond(piece, this.across, cut)),
    ];
    [this.at, this.sheets] = [cut, sheets];
    this.mesh.visible = sheets > 0;
    const count = 6 * sheets * this.pieces.length;
    const colors = new Float32Array(3 * count);
    for (let vertex = 0; vertex < count; vertex++)
      new Color(this.colors[Math.floor(vertex / 6) % sheets]!).toArray(colors, 3 * vertex);
    const { geometry } = this.mesh;
    geometry.dispose();
    const positions = new Float32BufferAttribute(new Float32Array(3 * count), 3);
    positions.setUsage(DynamicDrawUsage);
    geometry.setAttribute('position', positions);
    geometry.setAttribute('color', new Float32BufferAttribute(colors, 3));
  }

  /** @param positions of the points of all sheets, sheet by sheet. */
  move(positions: ArrayLike<number>): void {
    if (!this.mesh.visible) return;
    const places = this.mesh.geometry.getAttribute('position');
    const nodes = this.across.length;
    let vertex = 0;
    const put = ({ from, to, share }: Post, sheet: number): void => {
      const a = 3 * (from + sheet * nodes);
      const b = 3 * (to + sheet * nodes);
      const between = (axis: number): number =>
        positions[a + axis]! + share * (positions[b + axis]! - positions[a + axis]!);
      places.setXYZ(vertex++, between(0), between(1), between(2));
    };
    for (const [one, other] of this.pieces) {
      for (let sheet = 0; sheet < this.sheets; sheet++) {
        put(one, sheet);
        put(one, sheet + 1);
        put(other, sheet);
        put(other, sheet);
        put(one, sheet + 1);
        put(other, sheet + 1);
      }
    }
    places.needsUpdate = true;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}

/** What of a piece of the border between two points lies beyond the cut. */
function beyond([one, other]: Piece, across: ArrayLike<number>, cut: number): Piece[] {
  const [here, there] = [across[one.from]! - cut, across[other.from]! - cut];
  if (here <= 0 && there <= 0) return [];
  if (here > 0 && there > 0) return [[one, other]];
  const at = { from: one.from, to: other.from, share: here / (here - there) };
  return here > 0 ? [[one, at]] : [[at, other]];
}

function post(node: number): Post {
  return { from: node, to: node, share: 0 };
}

/** Where triangles are cut: a piece through each of them, from edge to edge. */
export function cutOf(
  triangles: ArrayLike<number>,
  across: ArrayLike<number>,
  cut: number,
): Piece[] {
  const found: Piece[] = [];
  for (let at = 0; at < triangles.length; at += 3) {
    const ends: Post[] = [];
    for (let edge = 0; edge < 3; edge++) {
      const [from, to] = [triangles[at + edge]!, triangles[at + ((edge + 1) % 3)]!];
      const [here, there] = [across[from]! - cut, across[to]! - cut];
      if (here > 0 !== there > 0) ends.push({ from, to, share: here / (here - there) });
    }
    if (ends.length === 2) found.push([ends[0]!, ends[1]!]);
  }
  return found;
}

function createSection(): ShaderMaterial {
  return new ShaderMaterial({
    side: DoubleSide,
    vertexColors: true,
    vertexShader: /* glsl */ `
      varying vec3 vColor3;
      varying vec3 vSeen;
      void main() {
        vColor3 = color;
        vec4 seen = modelViewMatrix * vec4(position, 1.0);
        vSeen = seen.xyz;
        gl_Position = projectionMatrix * seen;
      }`,
    fragmentShader: /* glsl */ `
      varying vec3 vColor3;
      varying vec3 vSeen;
      void main() {
        vec3 n = normalize(cross(dFdx(vSeen), dFdy(vSeen)));
        float key = max(0.0, dot(n, normalize(vec3(-0.35, 0.5, 0.8))));
        gl_FragColor = vec4(vColor3 * (0.4 + 0.5 * key), 1.0);
        #include <colorspace_fragment>
      }`,
  });
}
