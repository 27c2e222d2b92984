// All that the controls of a page hold at a moment: what undoing brings back, and what a performance records.

import type { Feeling } from './feelings';
import { dominanceAt } from './feelings';
import type { Numbers } from './protocol';
import type { Group } from './state/actions';
import type { ViewerState } from './state/viewer.svelte';
import type { Held } from './take';

export interface Snapshot {
  controls: Record<Group, Numbers>;
  emotion: string;
  intensity: number;
  feeling: Feeling | null;
}

/** What is held now; nothing that is moved later changes it. */
export function snapshotOf({ sliders, emotion, emotionIntensity, feeling }: ViewerState): Snapshot {
  const controls = JSON.parse(JSON.stringify(sliders.all())) as Snapshot['controls'];
  return { controls, emotion, intensity: emotionIntensity, feeling };
}

/** The same as a performance notes it: a feeling with the dominance that goes with it. */
export function heldOf(viewer: ViewerState): Held {
  const { controls, emotion, intensity, feeling } = snapshotOf(viewer);
  if (emotion !== '') return { controls, plays: { label: emotion, intensity } };
  if (feeling === null) return { controls, plays: null };
  return { controls, plays: { ...feeling, dominance: dominanceAt(feeling, viewer.places) } };
}
