// How far skin is wrinkled: gauges between tissue points shorten, and each spreads over the skin around it.

/** Pairs of streamed points, and the sparse matrix (drawn vertices x gauges) that spreads their compression. */
export interface Gauges {
  /** Streamed points at the ends of each gauge. */
  first: ArrayLike<number>;
  second: ArrayLike<number>;
  /** Length below which skin folds, a little less than at rest [m]. */
  rest: ArrayLike<number>;
  /** Weight per share of length lost. */
  gain: ArrayLike<number>;
  /** (d + 1,) */
  indptr: ArrayLike<number>;
  indices: ArrayLike<number>;
  weights: ArrayLike<number>;
}

/** Gives a streamed point's place now, as `out[0..2]` [m]. */
export type PlaceOf = (point: number, out: [number, number, number]) => void;

/** A weight of 8 bits would step; smaller changes than this do not show. */
const LEAST_CHANGE = 1 / 512;

export class Wrinkles {
  /** 0 smooth .. 1 fully wrinkled, per drawn vertex. */
  readonly weights: Float32Array;
  private readonly strains: Float32Array;
  private readonly a: [number, number, number] = [0, 0, 0];
  private readonly b: [number, number, number] = [0, 0, 0];

  constructor(private readonly gauges: Gauges) {
    this.weights = new Float32Array(gauges.indptr.length - 1);
    this.strains = new Float32Array(gauges.first.length);
  }

  /** Measure the gauges, and tell whether any vertex' weight has changed. */
  update(placeOf: PlaceOf): boolean {
    let changed = false;
    for (let gauge = 0; gauge < this.strains.length; gauge++) {
      const strain = this.strainOf(gauge, placeOf);
      if (Math.abs(strain - this.strains[gauge]!) < LEAST_CHANGE) continue;
      this.strains[gauge] = strain;
      changed = true;
    }
    if (changed) this.spread();
    return changed;
  }

  /** clamp(gain (1 - length / rest)) to 0..1. */
  private strainOf(gauge: number, placeOf: PlaceOf): number {
    const { first, second, rest, gain } = this.gauges;
    placeOf(first[gauge]!, this.a);
    placeOf(second[gauge]!, this.b);
    const length = Math.hypot(this.a[0] - this.b[0], this.a[1] - this.b[1], this.a[2] - this.b[2]);
    return clamped(gain[gauge]! * (1 - length / rest[gauge]!));
  }

  private spread(): void {
    const { indptr, indices, weights } = this.gauges;
    for (let vertex = 0; vertex < this.weights.length; vertex++) {
      let sum = 0;
      const end = indptr[vertex + 1]!;
      for (let k = indptr[vertex]!; k < end; k++) sum += weights[k]! * this.strains[indices[k]!]!;
      this.weights[vertex] = clamped(sum);
    }
  }
}

function clamped(value: number): number {
  return Math.min(1, Math.max(0, value));
}
