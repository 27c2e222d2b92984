// When what happened on the way to the first frame, for whoever times it.

/** In order: each is a mark of the page's own performance timeline, below `risorius.`. */
export type Moment =
  'script' | 'stage' | 'session' | 'hello' | 'surface' | 'first-frame' | 'complete';

/** Note that it is so far now; only the first time counts. */
export function mark(moment: Moment): void {
  const name = `risorius.${moment}`;
  if (performance.getEntriesByName(name).length === 0) performance.mark(name);
}
