// Where points of the skin have been: the last seconds of each, in ticks of the session's own time.

const TICKS_PER_SECOND = 60;
/** Moments drawn of a way; more are thinned evenly. */
const MOST_DRAWN = 48;

interface Moment {
  tick: number;
  /** From rest [m], x y z after x y z. */
  moved: Float32Array;
}

/** Lines from moment to moment, and how late each end was, 0 to 1. */
export interface Ways {
  /** Point and displacement from rest [m] of both ends. */
  point: Uint16Array;
  moved: Float32Array;
  late: Float32Array;
  /** Seconds from the first moment to the last. */
  seconds: number;
}

export class Trail {
  private moments: Moment[] = [];

  /** @param seconds how far back it goes. */
  constructor(public seconds: number) {}

  /** Remember where the points are. Time that ran backwards is another session's. */
  add(tick: number, moved: Float32Array): void {
    const last = this.moments.at(-1);
    if (last !== undefined && tick < last.tick) this.moments = [];
    if (last?.tick === tick) this.moments.pop();
    this.moments.push({ tick, moved: moved.slice() });
    const first = tick - this.seconds * TICKS_PER_SECOND;
    while (this.moments[0]!.tick < first) this.moments.shift();
  }

  /** A gesture begins: what was before is another one. */
  begin(): void {
    this.moments = this.moments.slice(-1);
  }

  /** Another face: where this one was does not count. */
  forget(): void {
    this.moments = [];
  }

  /** The ways of those points that went further than `least` [m] from one place to another. */
  ways(least: number): Ways {
    const kept = thinned(this.moments);
    const points = (kept[0]?.moved.length ?? 0) / 3;
    const first = kept[0]?.tick ?? 0;
    const span = Math.max(1, (kept.at(-1)?.tick ?? 0) - first);
    const [point, moved, late]: [number[], number[], number[]] = [[], [], []];
    for (let p = 0; p < points; p++) {
      if (reach(kept, p) < least) continue;
      for (let at = 1; at < kept.length; at++) {
        for (const moment of [kept[at - 1]!, kept[at]!]) {
          point.push(p);
          moved.push(...moment.moved.subarray(3 * p, 3 * p + 3));
          late.push((moment.tick - first) / span);
        }
      }
    }
    return {
      point: Uint16Array.from(point),
      moved: Float32Array.from(moved),
      late: Float32Array.from(late),
      seconds: kept.length > 1 ? span / TICKS_PER_SECOND : 0,
    };
  }
}

function thinned(moments: readonly Moment[]): Moment[] {
  const step = Math.max(1, (moments.length - 1) / (MOST_DRAWN - 1));
  const kept = [];
  for (let at = 0; at < moments.length - 1; at += step) kept.push(moments[Math.round(at)]!);
  return moments.length === 0 ? [] : [...new Set([...kept, moments.at(-1)!])];
}

/** How far a point gets from where it was first [m]. */
function reach(moments: readonly Moment[], point: number): number {
  const [x, y, z] = moments[0]!.moved.subarray(3 * point, 3 * point + 3) as unknown as number[];
  let most = 0;
  for (const { moved } of moments) {
    const away = Math.hypot(
      moved[3 * point]! - x!,
      moved[3 * point + 1]! - y!,
      moved[3 * point + 2]! - z!,
    );
    most = Math.max(most, away);
  }
  return most;
}
