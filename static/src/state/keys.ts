// The keys of the viewer, and what they ask for.

import type { Shortcut } from '../shortcuts';
import { VIEWS } from '../views';
import type { Actions } from './actions';
import { readable } from './rig';
import type { ViewerState } from './viewer.svelte';

const MOST_EMOTIONS = 9;

export function shortcutsOf(viewer: ViewerState, actions: Actions): Shortcut[] {
  const emotions = (): string[] =>
    (viewer.rig?.emotions ?? []).map(({ name }) => name).filter((name) => name !== 'neutral');
  const digits: Shortcut[] = Array.from({ length: MOST_EMOTIONS }, (_, index) => ({
    keys: [String(index + 1)],
    get does() {
      return readable(emotions()[index] ?? '');
    },
    run: () => {
      const name = emotions()[index];
      if (name !== undefined) actions.playEmotion(name, viewer.emotionIntensity);
    },
  }));
  const key = (keys: string[], does: string, run: () => void): Shortcut => ({ keys, does, run });
  const nextView = (): void => {
    const at = VIEWS.findIndex((name) => name === viewer.view);
    actions.setView(VIEWS[(at + 1) % VIEWS.length]!);
  };
  return [
    ...digits,
    key(['0'], 'Neutral', () => {
      actions.stopEmotion();
    }),
    key(['f'], 'Write FACS', () => {
      document.getElementById('facs')?.focus();
    }),
    key(['/'], 'Find an action unit or a muscle', () => {
      document.querySelector<HTMLElement>('#controls input[type=search]')?.focus();
    }),
    key(['v'], 'Next view', nextView),
    key(['m'], 'Muscles, seen or not', () => {
      actions.setInside(!viewer.inside);
    }),
    key(['l'], 'Idle life on and off', () => {
      actions.setAlive(!viewer.alive);
    }),
    key([' '], 'Play the take, or pause', () => {
      actions.playTake();
    }),
    key(['k'], 'Key: keep the pose in the timeline', () => {
      actions.keyTake();
    }),
    key(['mod+z'], 'Undo', () => {
      actions.undo();
    }),
    key(['mod+shift+z', 'mod+y'], 'Redo', () => {
      actions.redo();
    }),
    key(['r'], 'Reset: let go of every control', () => {
      actions.reset();
    }),
    key(['?'], 'This list', () => {
      viewer.keysShown = !viewer.keysShown;
    }),
  ];
}
