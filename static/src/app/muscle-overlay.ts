// The muscles over the face on the stage, while somebody looks inside.

import type { Face } from '../face';
import { groundOf } from '../ground';
import type { MuscleForm } from '../muscle-shape';
import { MuscleView } from '../muscle-view';
import type { Scene } from '../scene';
import type { ViewerState } from '../state/viewer.svelte';
import type { Overlay } from './on-stage';

export class MuscleOverlay implements Overlay {
  private face: Face | null = null;
  private muscles: readonly MuscleForm[] = [];
  private view: MuscleView | null = null;
  /** As it is drawn. */
  private inHand = '';

  constructor(
    private readonly viewer: ViewerState,
    private readonly scene: Scene,
  ) {}

  wear(face: Face | null): void {
    this.face = face;
    this.refresh();
  }

  /** Draw these, of the rig that is on the stage now. */
  use(muscles: readonly MuscleForm[]): void {
    this.muscles = muscles;
    this.refresh();
  }

  /** Draw them if they are asked for. */
  refresh(): void {
    this.view?.dispose();
    this.view = null;
    if (this.viewer.inside && this.face !== null && this.muscles.length > 0) {
      this.view = new MuscleView(this.muscles, groundOf(this.face));
      this.view.show(this.viewer.merged.muscles ?? {});
      this.view.hold(this.inHand);
      this.face.carry(this.view.mesh);
    }
    this.scene.invalidate();
  }

  /** What the face plays has changed. */
  glow(): void {
    if (this.view === null) return;
    this.view.show(this.viewer.merged.muscles ?? {});
    this.scene.wake();
  }

  move(): void {
    this.view?.move();
  }

  step(now: number): boolean {
    if (this.view === null) return false;
    const glows = this.view.step(now);
    const { muscle } = this.viewer.within;
    if (muscle === this.inHand) return glows;
    this.inHand = muscle;
    this.view.hold(muscle);
    return true;
  }
}
