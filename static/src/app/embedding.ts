// A page inside <risorius-face>: tells the page around how it is, obeys it, and rests while nobody sees it.

import type { Commands } from '../commands';
import type { Connection } from '../connection';
import type { ErrorMessage } from '../protocol';
import type { ViewerState } from '../state/viewer.svelte';
import { curtain } from './curtain';

const TELL_MS = 250;

interface Wish {
  risorius?: unknown;
  label?: unknown;
  intensity?: unknown;
}

type Refused = Pick<ErrorMessage, 'message' | 'known'>;

/** Tell the page around how the face is: whoever shows it may know, there is nothing secret in it. */
export function tellAround(how: { state: string; session: string; words: string }): void {
  window.parent.postMessage({ risorius: 'state', ...how }, '*');
}

/** Tell it also what the face was asked for and does not do. */
export function tellRefused({ message: words, known = [] }: Refused): void {
  window.parent.postMessage({ risorius: 'refused', words, known }, '*');
}

/** Stand in the element, as long as the page lives. */
export function embed(
  viewer: ViewerState,
  connection: Connection,
  commands: Commands,
  isReady: () => boolean,
): void {
  let told = '';
  let last = 'opening';
  let seen = true;
  /** What was asked while the face could not hear it. */
  let asked: (() => void) | null = null;
  const tell = (): void => {
    // Between two attempts nothing is better than before them.
    const held = viewer.status === 'connecting' && last === 'waiting';
    const open = isReady() && viewer.status === 'open';
    const over = viewer.isRefused;
    const state = !seen && !over ? 'resting' : open ? 'ready' : held ? last : stateOf(viewer);
    last = state;
    // The last picture of a face that is gone would pass for one that is there.
    if (over) curtain.close();
    if (open) {
      asked?.();
      asked = null;
    }
    const words = viewer.locked || viewer.notice || viewer.detail;
    const key = `${state} ${viewer.session} ${words}`;
    if (key === told) return;
    told = key;
    tellAround({ state, session: viewer.session, words });
  };
  window.setInterval(tell, TELL_MS);
  window.addEventListener('message', ({ source, data }: MessageEvent) => {
    const wish = data as Wish | null;
    if (source !== window.parent || wish?.risorius !== 'emotion') return;
    if (typeof wish.label !== 'string' || typeof wish.intensity !== 'number') return;
    const intensity = Math.min(1, Math.max(0, wish.intensity));
    const { label } = wish;
    asked = () => {
      if (label === '' || !Number.isFinite(intensity)) commands.stopEmotion();
      else commands.playEmotion(label, intensity);
    };
    tell();
  });
  new IntersectionObserver(([entry]) => {
    const now = entry?.isIntersecting ?? true;
    if (now === seen) return;
    seen = now;
    // What was refused for good is not asked for again at every turn of the page.
    if (!viewer.isRefused) {
      if (seen) connection.resume();
      else connection.close();
    }
    tell();
  }).observe(document.body);
}

function stateOf({ status, locked }: ViewerState): string {
  if (locked !== '') return 'locked';
  if (status === 'waiting') return 'waiting';
  return status === 'closed' ? 'closed' : 'opening';
}
