// What the page's address may ask for.

export const VIEWS = ['front', 'three-quarter', 'profile'] as const;
export type ViewName = (typeof VIEWS)[number];

export interface PageOptions {
  session: string | null;
  rig: string;
  /** No panels, fixed camera: for contact sheets and tests. */
  bare: boolean;
  view: ViewName;
  /** Device pixels per CSS pixel; null leaves it to the screen. */
  pixelRatio: number | null;
}

const DEFAULT_RIG = 'standard';

export function readPageOptions(search: string): PageOptions {
  const query = new URLSearchParams(search);
  const session = query.get('session');
  const view = query.get('view');
  const pixelRatio = Number(query.get('dpr'));
  return {
    session: session !== null && /^[a-z0-9_-]{1,64}$/.test(session) ? session : null,
    rig: query.get('rig') ?? DEFAULT_RIG,
    bare: query.get('bare') === '1',
    view: VIEWS.find((name) => name === view) ?? 'front',
    pixelRatio: pixelRatio > 0 && pixelRatio <= 4 ? pixelRatio : null,
  };
}
