// The layers under the skin of the face on the stage, peeled: fetched once, and where they are now a few times a second.

import type { Face } from '../face';
import { createHollow } from '../inside/hollow';
import type { LayersFrame } from '../inside/layers-frame';
import { LayerView } from '../inside/layer-view';
import { NOTHING_PEELED, Peel } from '../peel';
import type { Scene } from '../scene';
import type { ViewerState } from '../state/viewer.svelte';
import type { Overlay } from './on-stage';

/** Pause between two questions where the layers are [ms]. */
const PAUSE_MS = 120;
/** Time in which what is shown follows what was told, e-fold [ms]. */
const FOLLOW_MS = 70;
/** Nearer than this it is there [m]. */
const STILL = 1e-5;
const METRES = 1e-3;

export interface LayerSource {
  /** Address of the sheets and springs of the face on the stage. */
  file: () => string;
  /** Where they are now. */
  ask: () => Promise<LayersFrame>;
}

export class LayerOverlay implements Overlay {
  private face: Face | null = null;
  private view: LayerView | null = null;
  private peel: Peel | null = null;
  private hollow: ReturnType<typeof createHollow> | null = null;
  private loading: Promise<LayerView> | null = null;
  /** Dermis and hypodermis against the skin over them, the bone against rest [m]: told, and shown. */
  private told: Float32Array = new Float32Array();
  private shown: Float32Array = new Float32Array();
  private asking = false;
  private askedAt = -Infinity;
  private stale = false;
  private steppedAt = 0;

  constructor(
    private readonly viewer: ViewerState,
    private readonly scene: Scene,
    private readonly source: LayerSource,
  ) {}

  wear(face: Face | null): void {
    this.view?.dispose();
    this.hollow?.removeFromParent();
    this.hollow?.material.dispose();
    this.view = this.peel = this.hollow = this.loading = null;
    this.face = face;
    this.refresh();
  }

  /** The layers of the face on the stage, for whoever goes along its skull. @throws Error when they cannot be had. */
  load(): Promise<LayerView> {
    const { face } = this;
    if (face === null) return Promise.reject(new Error('There is no face yet.'));
    this.loading ??= LayerView.load(this.source.file())
      .then((view) => {
        if (face !== this.face) {
          view.dispose();
          throw new Error('Another face came.');
        }
        this.view = view;
        this.told = new Float32Array(9 * view.nodes);
        this.shown = new Float32Array(9 * view.nodes);
        face.carry(view.group);
        this.peel = new Peel(face.peelable, view.outline);
        this.hollow = createHollow(face);
        face.skin.add(this.hollow);
        return view;
      })
      .catch((error: unknown) => {
        if (face === this.face) this.loading = null;
        throw error;
      });
    return this.loading;
  }

  /** The skull's side; null until the layers are there. */
  get skull(): LayerView['skull'] | null {
    return this.view?.skull ?? null;
  }

  refresh(): void {
    const { peel, cut, structural, shear } = this.viewer.within;
    const { face, view } = this;
    if (peel > 0 && view === null && face !== null) {
      this.load().then(
        () => {
          this.refresh();
        },
        (error: unknown) => {
          if (face === this.face) this.viewer.sayWhy(error);
        },
      );
    }
    view?.peel(peel, { structural, shear });
    view?.cutAt(cut * METRES);
    if (face !== null && view !== null && this.peel !== null) {
      face.peelCut.value = peel > 0 ? cut * METRES : NOTHING_PEELED;
      this.peel.cutAt(face.peelCut.value);
      this.hollow!.visible = peel > 0;
    }
    if (peel > 0 && view !== null) {
      this.stale = true;
      this.place();
    }
    this.scene.invalidate();
  }

  move(): void {
    if (this.viewer.within.peel === 0 || this.view === null) return;
    this.stale = true;
    this.place();
  }

  step(now: number): boolean {
    if (this.viewer.within.peel === 0 || this.view === null) return false;
    if (this.stale && !this.asking && now - this.askedAt >= PAUSE_MS) void this.ask(now);
    else if (this.stale) this.scene.wake();
    const share = 1 - Math.exp(-Math.min(100, now - this.steppedAt) / FOLLOW_MS);
    this.steppedAt = now;
    let goesOn = false;
    for (let at = 0; at < this.told.length; at++) {
      const left = this.told[at]! - this.shown[at]!;
      if (left === 0) continue;
      goesOn = true;
      this.shown[at] = Math.abs(left) > STILL ? this.shown[at]! + share * left : this.told[at]!;
    }
    if (goesOn) this.place();
    return goesOn;
  }

  uncovered(): void {
    this.refresh();
  }

  private async ask(now: number): Promise<void> {
    const { view, face } = this;
    this.asking = true;
    this.askedAt = now;
    this.stale = false;
    try {
      const { nodes, displacements } = await this.source.ask();
      if (view === null || view !== this.view || nodes !== view.nodes) return;
      const moved = face!.tissue.moved;
      this.told = displacements.map((value, at) => {
        const inBone = at >= 6 * nodes;
        return inBone ? value : value - moved[at % (3 * nodes)]!;
      });
    } catch (error) {
      this.viewer.sayWhy(error);
    } finally {
      this.asking = false;
      this.scene.wake();
    }
  }

  /** Put the nodes where they are. */
  private place(): void {
    const view = this.view!;
    const { moved } = this.face!.tissue;
    const count = 3 * view.nodes;
    const all = new Float32Array(4 * count);
    all.set(moved.subarray(0, count));
    for (let at = 0; at < 3 * count; at++) {
      const skin = at < 2 * count ? moved[at % count]! : 0;
      all[count + at] = skin + this.shown[at]!;
    }
    view.move(all);
  }
}
