// The stage: renderer, lights, what stands on it; draws only when something has changed.

import type { Object3D } from 'three';
import { PCFShadowMap, Scene as ThreeScene, WebGLRenderer } from 'three';
import { drawnBy, finished, isSoftware } from './graphics';
import type { LightName } from './light-presets';
import { LIGHTS } from './light-presets';
import type { Ground } from './lights';
import { createBackdrop, createEnvironment, createLights, setGround } from './lights';
import type { Pair } from './pair';
import { drawPair } from './pair';
import { Resolution } from './resolution';
import { Sight } from './sight';
import { exposeSkin } from './tone';
import type { ViewpointOptions } from './viewpoint';
import { Viewpoint } from './viewpoint';

/** Lashes are thinner than a pixel: below this they fall apart into dots. */
const LEAST_PIXEL_RATIO = 1.5;
/** On the slowest devices, while things move. */
const COARSEST = 0.6;
/** So long after the last movement the picture is drawn as finely as it can be [ms]. */
const SHARP_AFTER_MS = 250;
/** Share of the camera's way around the face that the lights go with it. */
const LIGHTS_FOLLOW = 0.8;

export interface SceneOptions extends Omit<ViewpointOptions, 'onMoved'> {
  pixelRatio: number | null;
  /** Draw in fewer pixels where the device is too slow for all of them. */
  adaptive: boolean;
  /** Draw only when asked by `rendered`. */
  still: boolean;
  /** Leave out what takes long to prepare, whatever the device can do. */
  sketch: boolean;
  light: LightName;
  /** What it stands before; `none` shows the page behind. */
  ground: Ground | 'none';
  /** Take in what is new, e.g. the newest frame; tells whether it changed anything that is drawn. */
  update: () => boolean;
  /** It cannot draw, in a sentence; empty once it can again. */
  onTrouble?: (sentence: string) => void;
}

export class Scene {
  framesDrawn = 0;
  private readonly renderer: WebGLRenderer;
  private readonly backdrop = createBackdrop();
  private readonly scene = new ThreeScene();
  /** Where the visitor stands. */
  readonly viewpoint: Viewpoint;
  /** What lies where on the page. */
  readonly sight: Sight;
  private readonly observer: ResizeObserver;
  private readonly lights = createLights();
  /** Null where the ratio is given. */
  private readonly resolution: Resolution | null;
  /** What takes long to prepare is left out until `complete`: the driver draws in software, or so it is asked. */
  plain: boolean;
  private sharpening: ReturnType<typeof setTimeout> | undefined;
  private both: Pair | null = null;
  /** Device pixels per CSS pixel now, and the size that the picture has with it. */
  private ratio: number;
  private sized = '';
  private scheduled = false;
  private changed = false;
  private light: LightName;
  /** Nothing stands before the ground yet. */
  private empty = true;
  private waiting: (() => void)[] = [];

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly options: SceneOptions,
  ) {
    this.viewpoint = new Viewpoint(canvas, {
      ...options,
      onMoved: () => {
        this.invalidate();
      },
    });
    this.sight = new Sight(canvas, this.viewpoint.camera, this.viewpoint.target);
    this.renderer = new WebGLRenderer({
      canvas,
      antialias: true,
      alpha: options.ground === 'none',
      powerPreference: 'high-performance',
    });
    exposeSkin(this.renderer);
    this.plain = options.sketch || (options.adaptive && isSoftware(this.graphics));
    this.renderer.shadowMap.enabled = !this.plain;
    this.renderer.localClippingEnabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    const ratio =
      options.pixelRatio ?? Math.min(Math.max(window.devicePixelRatio, LEAST_PIXEL_RATIO), 2);
    // Who says how finely to draw gets that.
    this.resolution =
      options.adaptive && options.pixelRatio === null
        ? new Resolution(ratio, COARSEST, this.plain ? COARSEST : ratio)
        : null;
    this.ratio = this.resolution?.ratio ?? ratio;
    this.scene.add(this.lights.group);
    if (options.ground !== 'none') {
      this.scene.add(this.backdrop);
      setGround(this.backdrop, options.ground);
    }
    this.light = options.light;
    this.setLight(options.light);
    this.observer = new ResizeObserver(() => {
      this.resize();
    });
    this.observer.observe(canvas);
    canvas.addEventListener('webglcontextlost', () => {
      options.onTrouble?.('The graphics processor gave up; the face comes back when it does.');
    });
    canvas.addEventListener('webglcontextrestored', () => {
      options.onTrouble?.('');
      this.invalidate();
    });
  }

  add(object: Object3D): void {
    this.empty = false;
    this.scene.add(object);
    this.invalidate();
  }

  /** Draw two faces side by side; null draws one again. */
  pair(both: Pair | null): void {
    const changed = (both === null) !== (this.both === null);
    this.both = both;
    if (changed) this.resize();
    this.invalidate();
  }

  /** The graphics driver's name for itself. */
  get graphics(): string {
    return drawnBy(this.renderer.getContext());
  }

  setLight(name: LightName): void {
    this.light = name;
    this.lights.set(LIGHTS[name]);
    if (!this.plain) this.mirrorRoom();
    this.invalidate();
  }

  /** Draw something once, and show nothing of it: its programs are compiled then. */
  rehearse(object: Object3D): void {
    this.scene.add(object);
    this.renderer.render(this.scene, this.viewpoint.camera);
    object.removeFromParent();
  }

  /** Add what was left out at first: what surfaces mirror, and shadows. */
  complete(): void {
    if (!this.plain) return;
    this.plain = false;
    this.renderer.shadowMap.enabled = true;
    this.mirrorRoom();
    this.invalidate();
  }

  private mirrorRoom(): void {
    const { room } = LIGHTS[this.light];
    this.scene.environment?.dispose();
    this.scene.environment = createEnvironment(this.renderer, room);
    this.scene.environmentIntensity = room.intensity;
  }

  /** Resolves once the graphics processor has done all that it was told. */
  done(): Promise<void> {
    return finished(this.renderer.getContext() as WebGL2RenderingContext);
  }

  /** What is seen now, as a PNG file. */
  picture(): Promise<Blob> {
    this.draw();
    return new Promise((resolve, reject) => {
      // In the same task as the drawing: later the buffer may be empty.
      this.canvas.toBlob((blob) => {
        if (blob === null) reject(new Error('The browser makes no picture of this size.'));
        else resolve(blob);
      }, 'image/png');
    });
  }

  dispose(): void {
    clearTimeout(this.sharpening);
    this.observer.disconnect();
    this.viewpoint.dispose();
    this.scene.environment?.dispose();
    this.renderer.dispose();
  }

  setGround(ground: Ground): void {
    setGround(this.backdrop, ground);
    this.invalidate();
  }

  /** Something that is drawn has changed: draw with the next animation frame. */
  invalidate(): void {
    this.changed = true;
    this.wake();
  }

  /** There may be something new: ask `update` with the next animation frame, and draw if it says so. */
  wake(): void {
    if (this.scheduled) return;
    this.scheduled = true;
    requestAnimationFrame(() => {
      this.scheduled = false;
      this.viewpoint.step(performance.now());
      const updated = this.options.update();
      this.changed ||= updated;
      const asked = this.waiting.length > 0;
      // Before there is a face, the curtain hides all of it.
      if (this.changed && (asked || !(this.options.still || this.empty))) this.drawInTime();
    });
  }

  /** Draw, and see how long it keeps the next animation frame waiting: a busy device is late with it. */
  private drawInTime(): void {
    const { resolution } = this;
    if (resolution !== null) {
      clearTimeout(this.sharpening);
      this.useRatio(resolution.ratio);
      const started = performance.now();
      requestAnimationFrame(() => {
        if (!document.hidden) resolution.took(performance.now() - started);
        if (!this.changed) this.sharpenLater(resolution);
      });
    }
    this.draw();
  }

  private sharpenLater(resolution: Resolution): void {
    clearTimeout(this.sharpening);
    if (resolution.sharp === resolution.ratio) return;
    this.sharpening = setTimeout(() => {
      this.useRatio(resolution.sharp);
      this.draw();
    }, SHARP_AFTER_MS);
  }

  private useRatio(ratio: number): void {
    const { clientWidth: wide, clientHeight: high } = this.canvas;
    this.ratio = ratio;
    // Each change of its size makes the picture anew, and costs as much as drawing in it.
    const size = [wide, high, ratio].join();
    if (size !== this.sized) this.renderer.setDrawingBufferSize(wide, high, ratio);
    this.sized = size;
  }

  /** Resolves after the next drawing, which this asks for. */
  rendered(): Promise<void> {
    return new Promise((resolve) => {
      this.waiting.push(resolve);
      this.invalidate();
    });
  }

  private draw(): void {
    this.changed = false;
    this.turnLights();
    if (this.both === null) this.renderer.render(this.scene, this.viewpoint.camera);
    else drawPair(this.renderer, this.scene, this.viewpoint.camera, this.both);
    this.framesDrawn++;
    const waiting = this.waiting;
    this.waiting = [];
    for (const resolve of waiting) resolve();
  }

  private turnLights(): void {
    const angle = this.viewpoint.around * LIGHTS_FOLLOW;
    this.lights.group.rotation.y = angle;
    this.scene.environmentRotation.y = angle;
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.useRatio(this.ratio);
    const width = this.both === null ? clientWidth : clientWidth / 2;
    this.renderer.setViewport(0, 0, clientWidth, clientHeight);
    this.viewpoint.fit(width, clientHeight);
    this.invalidate();
  }
}
