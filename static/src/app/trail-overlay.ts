// The ways of points over the face: remembered as frames come, drawn while they are asked for.

import type { Face } from '../face';
import { Trail } from '../inside/trail';
import { TrailView } from '../inside/trail-view';
import type { Scene } from '../scene';
import type { ViewerState } from '../state/viewer.svelte';
import type { Overlay } from './on-stage';

/** Points that hardly move would only be dots [m]. */
const LEAST_WAY = 5e-4;
/** Ways are drawn anew this often at most [ms]. */
const PAUSE_MS = 80;

export class TrailOverlay implements Overlay {
  private face: Face | null = null;
  private view: TrailView | null = null;
  private readonly trail: Trail;
  private slept = true;
  private stale = false;
  private drawnAt = 0;

  /** @param tick of the frame that is drawn. */
  constructor(
    private readonly viewer: ViewerState,
    private readonly scene: Scene,
    private readonly tick: () => number,
  ) {
    this.trail = new Trail(viewer.within.seconds);
  }

  wear(face: Face | null): void {
    this.view?.dispose();
    this.view = null;
    this.face = face;
    this.trail.forget();
    // A way begins where the face came in, at rest, even if the next frame that is drawn is far from there.
    if (face !== null) this.trail.add(this.tick(), face.tissue.moved);
    this.refresh();
  }

  refresh(): void {
    const { trails, seconds } = this.viewer.within;
    this.trail.seconds = seconds;
    if (!trails || this.face === null) {
      this.view?.dispose();
      this.view = null;
    } else if (this.view === null) {
      this.view = new TrailView(this.face.restPoints);
      this.face.carry(this.view.lines);
    }
    this.stale = true;
    this.drawnAt = 0;
    this.scene.invalidate();
  }

  move(): void {
    if (this.face === null) return;
    // Where a face sleeps a gesture ends; the next one begins where it wakes.
    if (this.slept) this.trail.begin();
    this.slept = false;
    this.trail.add(this.tick(), this.face.tissue.moved);
    this.stale = true;
  }

  step(now: number): boolean {
    if (this.viewer.asleep) this.slept = true;
    if (!this.stale || this.view === null) return false;
    if (now - this.drawnAt < PAUSE_MS) {
      this.scene.wake();
      return false;
    }
    this.stale = false;
    this.drawnAt = now;
    const ways = this.trail.ways(LEAST_WAY);
    this.viewer.within.span = ways.seconds;
    this.view.show(ways);
    return true;
  }
}
