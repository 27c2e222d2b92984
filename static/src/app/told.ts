// What the service tells of the face: whose it is, what it plays, what can be moved.

import type { Api } from '../api';
import type { Commands } from '../commands';
import { HANDS_OFF_MS } from '../commands';
import { middleOf } from '../feelings';
import type { FaceState } from '../protocol';
import { expressionOf } from '../protocol';
import { facsOf } from '../state/facs';
import { describeRig } from '../state/rig';
import type { ViewerState } from '../state/viewer.svelte';
import { debounce } from '../throttle';
import type { MuscleEditing } from './muscle-editing';
import type { MuscleOverlay } from './muscle-overlay';

export class Told {
  /** Of the rig that the face is on. */
  rigId = '';
  /** What came while a control was in hand counts once the hand is off. */
  private readonly later = debounce((state: FaceState) => {
    this.take(state);
  }, HANDS_OFF_MS);

  constructor(
    private readonly api: Api,
    private readonly viewer: ViewerState,
    private readonly commands: Commands,
    private readonly muscles: MuscleOverlay,
    private readonly editing: MuscleEditing,
  ) {}

  /** A control was moved: what was told before is old. */
  forget(): void {
    this.later.cancel();
  }

  /** Show what a face holds and plays. */
  take(state: FaceState): void {
    const { viewer } = this;
    viewer.merged = state.merged ?? {};
    this.muscles.glow();
    viewer.facs = facsOf(state);
    this.later.cancel();
    const puppet = state.layers?.puppet ?? {};
    if (!this.commands.mayFollow(puppet)) {
      this.later(state);
      return;
    }
    if (state.idle !== undefined) viewer.alive = state.idle !== null;
    viewer.sliders.take(puppet);
    const emotion = state.layers?.emotion?.emotion;
    viewer.emotion = expressionOf(emotion);
    if (emotion !== undefined) viewer.emotionIntensity = emotion.intensity;
    if (emotion?.found !== 'coordinates') viewer.feeling = null;
    // The point itself is known to whoever put it there; others see about where it lies.
    else viewer.feeling ??= middleOf(emotion.parts ?? [], viewer.places);
  }

  /**
   * Describe the rig that the face is on.
   * @param isNew whether it is another face; otherwise an edit derived it, and the numbers of the first rig stay
   * what the sliders count from.
   * @throws Error when the service does not describe it; the next call may try the same again.
   */
  async showRig(id: string, isNew: boolean): Promise<void> {
    const { viewer } = this;
    this.rigId = id;
    const described = await this.api.rig(id).catch((error: unknown) => {
      if (this.rigId === id) this.rigId = '';
      throw error;
    });
    if (this.rigId !== id) return;
    viewer.recipe = described.recipe;
    const rig = describeRig(described);
    this.muscles.use(described.muscles);
    this.editing.use(described.muscles, isNew);
    if (isNew) {
      viewer.rig = rig;
      viewer.edits = {};
      if (viewer.rigName !== id) viewer.rigName = rig.name;
    } else if (viewer.rig !== null) {
      viewer.rig = { ...viewer.rig, id };
    }
  }
}
