// What a visitor of somebody else's page reads where the face should be: what its author needs to know goes to that page.

import type { ViewerState } from './viewer.svelte';

const TOO_MANY = 429;
const GONE = [404, 410];

/** One short sentence; empty where nothing is wrong, also while the face rests. */
export function visitorWords({
  status,
  answer,
  locked,
  isRefused,
}: Pick<ViewerState, 'status' | 'answer' | 'locked' | 'isRefused'>): string {
  if (locked !== '') return 'This face cannot be shown here.';
  if (status === 'waiting') {
    return answer === TOO_MANY
      ? 'No face is free just now. One moment, please.'
      : 'The face does not answer. Trying again.';
  }
  if (!isRefused) return '';
  return GONE.includes(answer) ? 'This face is not here.' : 'This face cannot be shown here.';
}
