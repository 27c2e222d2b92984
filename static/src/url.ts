// What the page's address may ask for.

import type { Level } from './level';
import { LEVELS } from './level';
import type { LightName } from './light-presets';
import { isLight } from './light-presets';
import { isView } from './views';

export interface PageOptions {
  session: string | null;
  rig: string;
  /** No panels, fixed camera: for contact sheets and tests. */
  bare: boolean;
  /** The face alone, before whatever lies behind it on the page that holds this one; see embed.ts. */
  embed: boolean;
  /** Whether a face that the page opens lives by itself; `idle=0` opens one at rest. */
  idle: boolean;
  /** Draw only when `__viewer.render()` asks: for pictures, where each costs seconds. */
  still: boolean;
  /** Stay with the sketch that slow devices show first: plain materials, no shadows; see sketch.ts. */
  sketch: boolean;
  /** Name of a view, or degrees aside. */
  view: string;
  /** How the studio is lit. */
  light: LightName;
  /** Device pixels per CSS pixel; null leaves it to the screen. */
  pixelRatio: number | null;
  /** Level of detail; null leaves it to the device. */
  level: Level | null;
}

const DEFAULT_RIG = 'standard';

export function readPageOptions(search: string): PageOptions {
  const query = new URLSearchParams(search);
  const session = query.get('session');
  const view = query.get('view') ?? '';
  const level = query.get('level');
  const light = query.get('light') ?? '';
  const pixelRatio = Number(query.get('dpr'));
  return {
    session: session !== null && /^[a-z0-9_-]{1,64}$/.test(session) ? session : null,
    rig: query.get('rig') ?? DEFAULT_RIG,
    bare: query.get('bare') === '1' || query.get('embed') === '1',
    embed: query.get('embed') === '1',
    idle: query.get('idle') !== '0',
    still: query.get('still') === '1',
    sketch: query.get('draw') === 'sketch',
    view: isView(view) || (view !== '' && Math.abs(Number(view)) <= 180) ? view : 'front',
    light: isLight(light) ? light : 'studio',
    pixelRatio: pixelRatio > 0 && pixelRatio <= 4 ? pixelRatio : null,
    level: LEVELS.find((name) => name === level) ?? null,
  };
}
