// window.__viewer: what browser tests, contact sheets and curious visitors may read and do.

import type { Triple } from './pose';
import type { Ground } from './lights';

export interface ViewerHandle {
  /** The face in its own materials, panels' data and a first frame are there. */
  readonly ready: boolean;
  readonly connected: boolean;
  readonly session: string;
  readonly rig: string;
  readonly tick: number;
  readonly framesDrawn: number;
  readonly asleep: boolean;
  /** The rig's maps are shown in full; also true if it has none, or they could not be had. */
  readonly textured: boolean;
  /** Drawn vertex of each anthropometric landmark. */
  readonly landmarks: Readonly<Record<string, number>>;
  /** A streamed point, by name or index, as drawn [mm, head frame]. */
  point(which: string | number): Triple;
  /** A vertex of the geometry buffer that is drawn [mm, head frame]. */
  drawnVertex(index: number): Triple;
  /** Where on the page the handles of the muscle in hand are drawn [CSS px]. */
  readonly handles: Readonly<Record<string, { x: number; y: number }>>;
  /** Stand at a view: a name of views.ts, or degrees aside. */
  setView(view: string | number): void;
  /** What stands behind the face: dark, as on the page, or light. */
  setGround(ground: Ground): void;
  /** Resolves after the next drawn frame. */
  render(): Promise<void>;
}

declare global {
  interface Window {
    __viewer: ViewerHandle;
  }
}
