// How finely to draw on a device that is slow: coarser while things move, sharp again once they rest.

/** Pictures that come later than this one after another are seen to stutter [ms]. */
const SLOW_MS = 40;
/** As quick as a screen goes: there is room for more pixels. */
const QUICK_MS = 19;
const COARSER = 0.8;
const FINER = 1.12;
/** Drawings that a step down, and a step up, are judged by. */
const FEW = 6;
const MANY = 90;
/** A last sharp picture may keep the page busy this long [ms]. */
const LONGEST_SHARP_MS = 700;

export class Resolution {
  /** Device pixels per CSS pixel to draw with now. */
  ratio: number;
  private times: number[] = [];
  /** What a drawing takes per square of the ratio [ms]. */
  private cost = 0;

  /**
   * @param full ratio of a quick device.
   * @param least ratio below which it is better to stutter.
   * @param first ratio to begin with, before anything is known of the device.
   */
  constructor(
    private readonly full: number,
    private readonly least: number,
    first = full,
  ) {
    this.ratio = first;
  }

  /**
   * A drawing, and all that goes with it, took so long [ms].
   * @returns whether the ratio has changed.
   */
  took(milliseconds: number): boolean {
    this.times.push(milliseconds);
    if (this.times.length < FEW) return false;
    const recent = middle(this.times.slice(-FEW));
    this.cost = recent / this.ratio ** 2;
    if (recent > SLOW_MS) return this.change(this.ratio * COARSER);
    if (this.times.length < MANY) return false;
    return middle(this.times) < QUICK_MS
      ? this.change(this.ratio * FINER)
      : this.change(this.ratio);
  }

  /** The ratio for a picture that stays, since nothing moves: full, unless that takes too long. */
  get sharp(): number {
    const affordable = this.cost > 0 ? Math.sqrt(LONGEST_SHARP_MS / this.cost) : this.full;
    return Math.max(this.ratio, Math.min(this.full, affordable));
  }

  private change(wanted: number): boolean {
    this.times = [];
    const before = this.ratio;
    this.ratio = Math.min(this.full, Math.max(this.least, wanted));
    return this.ratio !== before;
  }
}

function middle(values: readonly number[]): number {
  const sorted = [...values].sort((one, other) => one - other);
  return sorted[Math.floor(sorted.length / 2)]!;
}
