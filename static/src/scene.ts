// The stage: renderer, camera and views; draws only when something has changed.

import type { Mesh, Object3D } from 'three';
import {
  PCFShadowMap,
  PerspectiveCamera,
  Raycaster,
  Scene as ThreeScene,
  Vector2,
  Vector3,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { drawnBy, finished, isSoftware } from './graphics';
import type { LightName } from './light-presets';
import { LIGHTS } from './light-presets';
import type { Ground } from './lights';
import { createBackdrop, createEnvironment, createLights, setGround } from './lights';
import { steppedOrbit } from './orbit-keys';
import { Resolution } from './resolution';
import { exposeSkin } from './tone';
import type { PlaceOfLandmark, Shot } from './views';
import { shotOf } from './views';

/** Lashes are thinner than a pixel: below this they fall apart into dots. */
const LEAST_PIXEL_RATIO = 1.5;
/** On the slowest devices, while things move. */
const COARSEST = 0.6;
/** So long after the last movement the picture is drawn as finely as it can be [ms]. */
const SHARP_AFTER_MS = 250;
/** Share of the camera's way around the face that the lights go with it. */
const LIGHTS_FOLLOW = 0.8;
/** Degrees and time of the camera's way to its first view. */
const ENTER_FROM = 38;
const ENTER_MS = 1800;
/** How long the camera takes from one view to another [ms]. */
const GLIDE_MS = 900;
/** Degrees a second of the turntable: once round in half a minute. */
const TURNTABLE_SPEED = 12;
/** A step of the turntable after a pause, as of a hidden page, is no longer than this [ms]. */
const LONGEST_STEP_MS = 100;
/** Height of the bar over the stage, under which the head stands, and the least share that is left to the head [CSS px]. */
const BAR_HEIGHT = 52;
const LEAST_FREE = 0.85;

/** A longer lens would flatten the face, a wider one spoils it [degrees]. */
const FIELD_OF_VIEW = 22;
const ELEVATION = (2 * Math.PI) / 180;
/** From nearer than this [m] a face looks like one in a door's peephole. */
const LEAST_DISTANCE = 0.5;
/** How near and far a visitor may go, by the distance of the view [shares]. */
const NEAREST = 0.45;
const FARTHEST = 2.8;

const UP = new Vector3(0, 1, 0);

/** Two that are drawn side by side, as seen from the same place; null while one is on its way. */
export interface Pair {
  left: Object3D | null;
  right: Object3D | null;
}

/** What a pointer touches of a mesh. */
export interface Hit {
  corners: [number, number, number];
  /** Of the corners, at the place. */
  weights: [number, number, number];
  /** In the mesh's own frame [mm]. */
  place: [number, number, number];
}

export interface SceneOptions {
  /** Let the visitor turn the camera. */
  orbit: boolean;
  pixelRatio: number | null;
  /** Draw in fewer pixels where the device is too slow for all of them. */
  adaptive: boolean;
  /** Draw only when asked by `rendered`. */
  still: boolean;
  /** Leave out what takes long to prepare, whatever the device can do. */
  sketch: boolean;
  view: string;
  light: LightName;
  /** What it stands before; `none` shows the page behind. */
  ground: Ground | 'none';
  /** Where the face has a landmark; close-ups look at them. */
  placeOf: PlaceOfLandmark;
  /** Take in what is new, e.g. the newest frame; tells whether it changed anything that is drawn. */
  update: () => boolean;
  /** The turntable began, or ended. */
  onTurning?: (turning: boolean) => void;
  /** It cannot draw, in a sentence; empty once it can again. */
  onTrouble?: (sentence: string) => void;
}

export class Scene {
  framesDrawn = 0;
  private readonly renderer: WebGLRenderer;
  private readonly backdrop = createBackdrop();
  private readonly scene = new ThreeScene();
  private readonly camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.05, 5);
  private readonly controls: OrbitControls | null;
  private readonly observer: ResizeObserver;
  private readonly lights = createLights();
  /** Null where the ratio is given. */
  private readonly resolution: Resolution | null;
  /** What takes long to prepare is left out until `complete`: the driver draws in software, or so it is asked. */
  plain: boolean;
  private sharpening: ReturnType<typeof setTimeout> | undefined;
  private turning = false;
  private steppedAt = 0;
  private view: string;
  private shot: Shot;
  private readonly target = new Vector3();
  /** Degrees aside at which the camera stands, on its way to its view. */
  private angle: number;
  private glide: { from: number; to: number; start: number; duration: number } | null = null;
  /** The camera stands where a view put it, so that resizing may frame it anew. */
  private framed = true;
  private both: Pair | null = null;
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
    this.view = options.view;
    this.shot = shotOf(this.view, options.placeOf);
    this.angle = this.shot.angle;
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
    this.renderer.setPixelRatio(ratio);
    // Who says how finely to draw gets that.
    this.resolution =
      options.adaptive && options.pixelRatio === null
        ? new Resolution(ratio, COARSEST, this.plain ? COARSEST : ratio)
        : null;
    this.scene.add(this.lights.group);
    if (options.ground !== 'none') {
      this.scene.add(this.backdrop);
      setGround(this.backdrop, options.ground);
    }
    this.light = options.light;
    this.setLight(options.light);
    this.controls = options.orbit ? this.createControls() : null;
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
    this.resize();
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

  /** What is under a place of the page, of one mesh; null where there is nothing of it. */
  hit(mesh: Mesh, x: number, y: number): Hit | null {
    const [found] = this.ray(x, y).intersectObject(mesh, false);
    if (found?.face == null || found.barycoord == null) return null;
    const { a, b, c } = found.face;
    const place = mesh.worldToLocal(found.point).multiplyScalar(1000);
    return { corners: [a, b, c], weights: found.barycoord.toArray(), place: place.toArray() };
  }

  /** The line of sight through a place of the page, in the frame of an object [mm]. */
  rayIn(
    object: Object3D,
    x: number,
    y: number,
  ): Record<'origin' | 'direction', [number, number, number]> {
    const { origin, direction } = this.ray(x, y).ray;
    const towards = object.worldToLocal(origin.clone().add(direction));
    const from = object.worldToLocal(origin.clone());
    return {
      origin: from.clone().multiplyScalar(1000).toArray(),
      direction: towards.sub(from).normalize().toArray(),
    };
  }

  /** Where on the page a place of the world is drawn [CSS px]. */
  screenPlace(place: Vector3): { x: number; y: number } {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const at = place.clone().project(this.camera);
    return { x: left + (0.5 + at.x / 2) * width, y: top + (0.5 - at.y / 2) * height };
  }

  /** Whether a place of the head's surface looks this way, and not off the far side. */
  facing(place: Vector3): boolean {
    const seen = this.camera.position.clone().sub(this.target);
    return place.x * seen.x + place.z * seen.z > 0;
  }

  private ray(x: number, y: number): Raycaster {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const at = new Vector2((2 * (x - left)) / width - 1, 1 - (2 * (y - top)) / height);
    const caster = new Raycaster();
    caster.setFromCamera(at, this.camera);
    return caster;
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

  /** Go round the head, until told not to, or until somebody takes the camera in hand. */
  setTurning(turning: boolean): void {
    if (turning === this.turning) return;
    this.turning = turning;
    this.steppedAt = performance.now();
    this.options.onTurning?.(turning);
    this.wake();
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
    this.controls?.dispose();
    this.scene.environment?.dispose();
    this.renderer.dispose();
  }

  /**
   * Stand at a view: a name of views.ts, or degrees aside.
   * @throws Error when there is none of that name.
   */
  setGround(ground: Ground): void {
    setGround(this.backdrop, ground);
    this.invalidate();
  }

  setView(view: string | number): void {
    this.shot = shotOf(String(view), this.options.placeOf);
    this.view = String(view);
    this.angle = this.shot.angle;
    this.glide = null;
    this.frame();
    this.invalidate();
  }

  /** The face has changed: its landmarks may lie elsewhere. */
  reframe(): void {
    if (!this.framed || this.glide !== null) return;
    this.shot = shotOf(this.view, this.options.placeOf);
    this.frame();
    this.invalidate();
  }

  /** Go round to a view, as someone would who walks about the head; at once for who wants no motion. */
  glideTo(name: string, from = this.standing(), duration = GLIDE_MS): void {
    this.setTurning(false);
    this.setView(name);
    if (window.matchMedia('(prefers-reduced-motion: reduce)').matches) return;
    this.glide = { from, to: this.angle, start: performance.now(), duration };
    this.stepGlide(performance.now());
  }

  /** Show that the head is one to walk around: come from the side. */
  enter(): void {
    this.glideTo(this.view, this.angle + ENTER_FROM, ENTER_MS);
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
      this.stepGlide(performance.now());
      this.stepTurntable(performance.now());
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
    if (ratio !== this.renderer.getPixelRatio()) this.renderer.setPixelRatio(ratio);
  }

  /** Resolves after the next drawing, which this asks for. */
  rendered(): Promise<void> {
    return new Promise((resolve) => {
      this.waiting.push(resolve);
      this.invalidate();
    });
  }

  /** Degrees aside at which the camera stands now, also where the visitor has turned it. */
  private standing(): number {
    const { x, z } = this.offset();
    return (Math.atan2(x, z) * 180) / Math.PI;
  }

  private offset(): Vector3 {
    return this.camera.position.clone().sub(this.target);
  }

  private stepGlide(now: number): void {
    if (this.glide === null) return;
    const { from, to, start, duration } = this.glide;
    const share = Math.min(1, Math.max(0, (now - start) / duration));
    this.angle = to + (from - to) * (1 - share) ** 3;
    if (share === 1) this.glide = null;
    this.frame();
    this.invalidate();
  }

  private stepTurntable(now: number): void {
    if (!this.turning || this.glide !== null) return;
    const degrees = (TURNTABLE_SPEED * Math.min(now - this.steppedAt, LONGEST_STEP_MS)) / 1000;
    this.steppedAt = now;
    const offset = this.offset().applyAxisAngle(UP, (degrees * Math.PI) / 180);
    this.camera.position.copy(this.target).add(offset);
    this.camera.lookAt(this.target);
    this.framed = false;
    this.invalidate();
  }

  private draw(): void {
    this.changed = false;
    this.turnLights();
    if (this.both === null) this.renderer.render(this.scene, this.camera);
    else this.drawBoth(this.both);
    this.framesDrawn++;
    const waiting = this.waiting;
    this.waiting = [];
    for (const resolve of waiting) resolve();
  }

  /** Each in its half of the picture. */
  private drawBoth({ left, right }: Pair): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    this.renderer.setScissorTest(true);
    for (const [half, shown, hidden] of [
      [0, left, right],
      [1, right, left],
    ] as const) {
      if (shown !== null) shown.visible = true;
      if (hidden !== null) hidden.visible = false;
      this.renderer.setViewport((half * width) / 2, 0, width / 2, height);
      this.renderer.setScissor((half * width) / 2, 0, width / 2, height);
      this.renderer.render(this.scene, this.camera);
    }
    if (left !== null) left.visible = true;
    this.renderer.setScissorTest(false);
  }

  private turnLights(): void {
    const from = this.camera.position;
    const angle = Math.atan2(from.x - this.target.x, from.z - this.target.z) * LIGHTS_FOLLOW;
    this.lights.group.rotation.y = angle;
    this.scene.environmentRotation.y = angle;
  }

  private createControls(): OrbitControls {
    const controls = new OrbitControls(this.camera, this.canvas);
    controls.enablePan = false;
    controls.rotateSpeed = 0.7;
    controls.minPolarAngle = 0.25 * Math.PI;
    controls.maxPolarAngle = 0.72 * Math.PI;
    controls.addEventListener('start', () => {
      this.framed = false;
      this.glide = null;
      this.setTurning(false);
    });
    controls.addEventListener('change', () => {
      this.invalidate();
    });
    this.canvas.addEventListener('keydown', (event) => {
      const to = event.ctrlKey || event.metaKey ? null : steppedOrbit(this.offset(), event.key);
      if (to === null) return;
      event.preventDefault();
      this.framed = false;
      this.glide = null;
      this.setTurning(false);
      // The controls hold it to where a pointer may go, too.
      this.camera.position.copy(this.target).add(to);
      controls.update();
      this.invalidate();
    });
    return controls;
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    const width = this.both === null ? clientWidth : clientWidth / 2;
    this.renderer.setViewport(0, 0, clientWidth, clientHeight);
    this.camera.aspect = width / clientHeight;
    if (this.options.orbit) {
      this.camera.setViewOffset(width, clientHeight, 0, -BAR_HEIGHT / 2, width, clientHeight);
    }
    this.camera.updateProjectionMatrix();
    if (this.framed) this.frame();
    this.invalidate();
  }

  /** Share of the stage's height that the bar leaves free. */
  private shareUnderBar(): number {
    const { clientHeight } = this.canvas;
    if (!this.options.orbit || clientHeight === 0) return 1;
    return Math.max(LEAST_FREE, 1 - BAR_HEIGHT / clientHeight);
  }

  /** Stand where all of the view fits, whatever the window's shape. */
  private frame(): void {
    const angle = (this.angle * Math.PI) / 180;
    const slope = Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
    const { halfHeight, halfWidth } = this.shot;
    const upright = this.shareUnderBar() * slope;
    const nearest = Math.max(halfHeight / upright, halfWidth / (slope * this.camera.aspect));
    // For a close-up one takes a longer lens, and does not hold the camera to the nose.
    const distance = Math.max(nearest, LEAST_DISTANCE);
    this.camera.fov = (360 / Math.PI) * Math.atan((slope * nearest) / distance);
    this.camera.updateProjectionMatrix();
    this.target.set(...this.shot.target);
    this.camera.position
      .set(
        Math.sin(angle) * Math.cos(ELEVATION),
        Math.sin(ELEVATION),
        Math.cos(angle) * Math.cos(ELEVATION),
      )
      .multiplyScalar(distance)
      .add(this.target);
    this.camera.lookAt(this.target);
    if (this.controls !== null) {
      this.controls.target.copy(this.target);
      this.controls.minDistance = NEAREST * distance;
      this.controls.maxDistance = FARTHEST * distance;
      this.controls.update();
    }
    this.framed = true;
  }
}
