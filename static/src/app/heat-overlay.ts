// The skin coloured by strain, or by how far it has moved.

import type { Face } from '../face';
import { HeatSkin } from '../inside/heat-skin';
import { Strains } from '../inside/strain';
import type { Scene } from '../scene';
import { SCALES } from '../state/inside.svelte';
import type { ViewerState } from '../state/viewer.svelte';
import type { Overlay } from './on-stage';

const MILLIMETRES = 1000;
const PERCENT = 100;

export class HeatOverlay implements Overlay {
  private face: Face | null = null;
  private strains: Strains | null = null;
  private skin: HeatSkin | null = null;
  /** Where the drawn skin was at the moment that is held [m]; null for rest. */
  private held: Float32Array | null = null;

  constructor(
    private readonly viewer: ViewerState,
    private readonly scene: Scene,
  ) {}

  wear(face: Face | null): void {
    this.skin = null; // It went with its face.
    this.face = face;
    this.held = null;
    this.strains = face === null ? null : new Strains(face.tissue.rest, face.tissue.triangles);
    this.refresh();
  }

  /** Count ways from where the skin is now, or from rest again. */
  hold(held: boolean): void {
    this.held = held && this.face !== null ? this.face.skinPlaces.now.slice() : null;
    this.refresh();
  }

  refresh(): void {
    const { heat } = this.viewer.within;
    if (heat === 'off') {
      this.skin?.dispose();
      this.skin = null;
    } else if (this.face !== null) {
      this.skin ??= new HeatSkin(this.face);
      this.move();
    }
    this.scene.invalidate();
  }

  move(): void {
    const { within } = this.viewer;
    if (this.skin === null || within.heat === 'off') return;
    const amounts = this.amounts(within.heat);
    this.skin.show(amounts, SCALES[within.heat].most);
    within.greatest = amounts.reduce((most, amount) => Math.max(most, amount), 0);
  }

  step(): boolean {
    return false;
  }

  uncovered(): void {
    this.skin = null; // What it would put back is not the skin's own.
    this.refresh();
  }

  /** At the drawn vertices, in the unit of the scale. */
  private amounts(heat: 'stretch' | 'press' | 'moved'): Float32Array {
    const face = this.face!;
    if (heat !== 'moved') {
      const strain = this.strains!.of(face.tissue.moved)[heat];
      return face.spread(strain.map((share) => PERCENT * share));
    }
    const { rest, now } = face.skinPlaces;
    const from = this.held ?? rest;
    return Float32Array.from({ length: rest.length / 3 }, (_, at) => {
      const way = (axis: number): number => now[3 * at + axis]! - from[3 * at + axis]!;
      return MILLIMETRES * Math.hypot(way(0), way(1), way(2));
    });
  }
}
