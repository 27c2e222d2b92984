// Strain of the tissue's surface: how far its elements are stretched and pressed, as engineers count it.

/** Smaller triangles [m²] have no strain to speak of. */
const LEAST_AREA = 1e-9;

export interface Strain {
  /** Greatest principal stretch less 1, at each point; 0 where nothing is longer than at rest. */
  stretch: Float32Array;
  /** 1 less the smallest principal stretch; 0 where nothing is shorter. */
  press: Float32Array;
}

export class Strains {
  private readonly area: Float64Array;
  /** Of each triangle the inverse of its sides at rest in its own plane: xx, xy, yy. */
  private readonly inverse: Float64Array;
  private readonly weight: Float64Array;

  /**
   * @param rest points [m], x y z after x y z.
   * @param triangles three points each.
   */
  constructor(
    private readonly rest: ArrayLike<number>,
    private readonly triangles: ArrayLike<number>,
  ) {
    const count = triangles.length / 3;
    this.area = new Float64Array(count);
    this.inverse = new Float64Array(3 * count);
    this.weight = new Float64Array(rest.length / 3);
    for (let t = 0; t < count; t++) this.measure(t);
  }

  /** Strain at the points, each the mean of the elements around it by area. @param moved from rest [m]. */
  of(moved: ArrayLike<number>): Strain {
    const points = this.weight.length;
    const stretch = new Float32Array(points);
    const press = new Float32Array(points);
    for (let t = 0; t < this.area.length; t++) {
      const area = this.area[t]!;
      if (area < LEAST_AREA) continue;
      const [long, short] = this.principal(t, moved);
      for (let corner = 0; corner < 3; corner++) {
        const point = this.triangles[3 * t + corner]!;
        const share = area / this.weight[point]!;
        stretch[point]! += share * Math.max(0, long - 1);
        press[point]! += share * Math.max(0, 1 - short);
      }
    }
    return { stretch, press };
  }

  private measure(t: number): void {
    const [a, b] = this.sides(t, null);
    const length = Math.hypot(...a);
    const along = dot(a, b) / Math.max(length, 1e-12);
    const across = Math.sqrt(Math.max(0, dot(b, b) - along * along));
    this.area[t] = 0.5 * length * across;
    if (this.area[t]! < LEAST_AREA) return;
    this.inverse.set([1 / length, -along / (length * across), 1 / across], 3 * t);
    for (let corner = 0; corner < 3; corner++) {
      this.weight[this.triangles[3 * t + corner]!]! += this.area[t]!;
    }
  }

  /** Greatest and smallest stretch of a triangle: the roots of its right Cauchy-Green tensor's values. */
  private principal(t: number, moved: ArrayLike<number>): [number, number] {
    const [a, b] = this.sides(t, moved);
    const [xx, xy, yy] = [0, 1, 2].map((at) => this.inverse[3 * t + at]!) as [
      number,
      number,
      number,
    ];
    const first = a.map((value) => value * xx);
    const second = a.map((value, axis) => value * xy + b[axis]! * yy);
    const [c11, c12, c22] = [dot(first, first), dot(first, second), dot(second, second)];
    const middle = (c11 + c22) / 2;
    const spread = Math.hypot((c11 - c22) / 2, c12);
    return [Math.sqrt(middle + spread), Math.sqrt(Math.max(0, middle - spread))];
  }

  private sides(t: number, moved: ArrayLike<number> | null): [number[], number[]] {
    const at = (corner: number, axis: number): number => {
      const index = 3 * this.triangles[3 * t + corner]! + axis;
      return this.rest[index]! + (moved?.[index] ?? 0);
    };
    const side = (corner: number): number[] =>
      [0, 1, 2].map((axis) => at(corner, axis) - at(0, axis));
    return [side(1), side(2)];
  }
}

function dot(one: readonly number[], other: readonly number[]): number {
  return one[0]! * other[0]! + one[1]! * other[1]! + one[2]! * other[2]!;
}
