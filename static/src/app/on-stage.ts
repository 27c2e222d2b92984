// The face on the stage: loaded, drawn as the frames come, and what lies over it.

import { Face } from '../face';
import type { SurfaceFrame } from '../surface-frame';
import type { Level } from '../level';
import { levelFor } from '../level';
import { mark } from '../marks';
import { Scene } from '../scene';
import { sketch, sketchSample } from '../sketch';
import { fetching, painting } from '../state/loading';
import type { ViewerState } from '../state/viewer.svelte';
import { useTheme } from '../theme';
import { withTicket } from '../ticket';
import { TickRate } from '../tick-rate';
import type { PageOptions } from '../url';
import { curtain } from './curtain';

/** Something that is drawn over the face and goes with it. */
export interface Overlay {
  /** There is another face, or none. */
  wear(face: Face | null): void;
  /** The face has moved. */
  move(): void;
  /** Go on by itself, e.g. with a fade; tells whether it changed what is drawn. */
  step(now: number): boolean;
  /** A face that was drawn plainly has its own materials now. */
  uncovered?(): void;
}

export interface OnStageOptions {
  page: PageOptions;
  viewer: ViewerState;
  /** Where the face is drawn. */
  canvas: HTMLCanvasElement;
  /** The newest frame since the last call; null if there is none. */
  takeFrame: () => SurfaceFrame | null;
  /** Of the session, where the service asks for one. */
  ticket: () => string;
  /** Whom the page shows, for sentences. */
  who: () => string;
  /** The browser cannot draw. @param words one sentence. */
  onNothingDrawn: (words: string) => void;
}

export class OnStage {
  readonly scene: Scene;
  face: Face | null = null;
  /** The face is drawn with all that belongs to it. */
  complete = false;
  /** Of the newest frame that was drawn. */
  tick = 0;
  /** A frame of this face was drawn. */
  frameSeen = false;
  /** The face that is wanted is on its way; the one shown is another. */
  loading = false;
  /** Address of the surface that is wanted. */
  address = '';
  /** The newest frame that was drawn. */
  newest: SurfaceFrame | null = null;
  private readonly overlays: Overlay[] = [];
  private readonly rate = new TickRate();
  /** Gives a face that is drawn plainly its own materials. */
  private uncover: (() => void) | null = null;

  /** @throws Error where the browser cannot draw; the curtain says so. */
  constructor(private readonly options: OnStageOptions) {
    this.scene = this.createScene();
  }

  /** Draw something over this face, and over those that come after it. */
  addOverlay(overlay: Overlay): void {
    this.overlays.push(overlay);
    overlay.wear(this.face);
  }

  /**
   * Load a surface, and put it on the stage in place of the one before.
   * @throws Error when it cannot be had; the next call may try the same again.
   */
  async show(address: string): Promise<void> {
    const { viewer, page, who, ticket } = this.options;
    this.address = address;
    this.loading = true;
    this.frameSeen = false;
    this.complete = false;
    viewer.step = fetching(who(), 0, 0);
    const loading = Face.load(withTicket(address, ticket()), (bytes, total) => {
      if (this.address === address) viewer.step = fetching(who(), bytes, total);
    });
    // What a sketch is drawn with is compiled while the face is on its way.
    const sample = this.scene.plain ? sketchSample() : null;
    if (sample !== null) this.scene.rehearse(sample.root);
    const loaded = await loading.catch((error: unknown) => {
      sample?.dispose();
      if (this.address === address) {
        this.address = '';
        this.loading = false;
      }
      throw error;
    });
    if (this.address !== address) {
      loaded.dispose();
      sample?.dispose();
      return;
    }
    this.face?.dispose();
    this.face = loaded;
    this.newest = null;
    this.loading = false;
    mark('surface');
    this.uncover = this.scene.plain ? sketch(loaded.root, loaded.peelCut) : null;
    this.scene.add(loaded.root);
    this.scene.viewpoint.reframe();
    viewer.surfaceReady = true;
    viewer.regions = [...loaded.regionNames].sort();
    viewer.step = null;
    for (const overlay of this.overlays) overlay.wear(loaded);
    // The frame that came while loading is still waiting, and is drawn now.
    await this.scene.rendered();
    await this.scene.done();
    sample?.dispose();
    mark('first-frame');
    if (!page.bare && !curtain.isOpen && this.uncover === null) this.scene.viewpoint.enter();
    curtain.open();
  }

  /** Give the face all that it was shown without at first, unless a sketch is all that is asked for. */
  async finish(): Promise<void> {
    if (this.complete || this.face === null || this.loading) return;
    if (!this.options.page.sketch) await this.dress(this.face);
    this.complete = true;
    mark('complete');
  }

  /** Put on a face its own materials, light that it mirrors, and maps. */
  private async dress(face: Face): Promise<void> {
    const { uncover } = this;
    this.uncover = null;
    if (uncover !== null) {
      await aPause();
      this.scene.complete();
      uncover();
      for (const overlay of this.overlays) overlay.uncovered?.();
      await this.scene.rendered();
    }
    void this.loadMaps(face);
  }

  /** What the device can do; a picture of the page shows all that there is. */
  chooseLevel(): Level {
    const { page } = this.options;
    if (page.level !== null || (page.bare && !page.embed)) return page.level ?? 'high';
    const { deviceMemory } = navigator as Navigator & { deviceMemory?: number };
    return levelFor({
      memory: deviceMemory ?? null,
      screen: Math.min(window.screen.width, window.screen.height),
      touch: window.matchMedia('(pointer: coarse)').matches,
      graphics: this.scene.graphics,
    });
  }

  /** @throws Error while there is no face. */
  get shown(): Face {
    if (this.face === null) throw new Error('The face is not loaded yet; wait for __viewer.ready.');
    return this.face;
  }

  private createScene(): Scene {
    const { page, viewer, canvas } = this.options;
    try {
      return new Scene(canvas, {
        orbit: !page.bare,
        pixelRatio: page.pixelRatio,
        adaptive: !page.bare || page.embed,
        still: page.still,
        sketch: page.sketch,
        view: page.view,
        light: page.light,
        ground: page.embed ? 'none' : page.bare ? 'dark' : useTheme(viewer.theme),
        onTurning: (turning) => (viewer.turning = turning),
        onTrouble: (sentence) => {
          viewer.say(sentence);
        },
        placeOf: (name) => this.face?.landmarkPlace(name) ?? null,
        update: () => this.update(),
      });
    } catch (error) {
      const words = 'This browser cannot draw the face: it has no WebGL 2.';
      curtain.element().textContent = words;
      this.options.onNothingDrawn(words);
      throw error;
    }
  }

  /** Take in what is new; tells whether it changed what is drawn. */
  private update(): boolean {
    const faded = this.face?.stepFade(performance.now(), moving(this.options.page)) ?? false;
    if (this.face?.fading === true) this.scene.wake();
    const moved = this.applyNewestFrame();
    let stepped = false;
    for (const overlay of this.overlays) {
      if (moved) overlay.move();
      if (overlay.step(performance.now())) stepped = true;
    }
    if (stepped) this.scene.wake();
    return moved || faded || stepped;
  }

  /** Tells whether the face changed. */
  private applyNewestFrame(): boolean {
    const { viewer, takeFrame } = this.options;
    if (this.face === null || this.loading) return false;
    try {
      const frame = takeFrame();
      if (frame === null) return false;
      const changed = this.face.apply(frame);
      this.newest = frame;
      this.frameSeen = true;
      this.tick = frame.tick;
      viewer.asleep = frame.asleep;
      viewer.tickRate = this.rate.at(frame.tick, performance.now());
      return changed;
    } catch (error) {
      viewer.say(error instanceof Error ? error.message : 'A frame cannot be drawn.');
      return false;
    }
  }

  /** Fetch the face's maps while it already shows; without them it stays as it is. */
  private async loadMaps(loading: Face): Promise<void> {
    const { viewer } = this.options;
    const missing = await loading.loadMaps((done, maps) => {
      if (loading === this.face) viewer.step = done < maps ? painting(done, maps) : null;
    });
    // A console note, and no notice: the face works without.
    // eslint-disable-next-line no-console
    if (missing !== '') console.warn(missing);
    if (loading === this.face) this.scene.wake();
  }
}

/** A visitor sees the maps fade in; a picture of the page need not wait, nor who wants no motion. */
export function moving(page: PageOptions): boolean {
  const picture = page.bare && !page.embed;
  return !picture && !window.matchMedia('(prefers-reduced-motion: reduce)').matches;
}

/** Let the page show what was drawn, before it is kept busy again. */
function aPause(): Promise<void> {
  return new Promise((resume) => setTimeout(resume, 50));
}
