// Where the visitor stands: at a view, on the way to one, going round, or wherever they have turned to.

import { PerspectiveCamera, Vector3 } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { steppedOrbit } from './orbit-keys';
import type { PlaceOfLandmark, Shot } from './views';
import { shotOf } from './views';

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

export interface ViewpointOptions {
  /** Let the visitor turn the camera. */
  orbit: boolean;
  view: string;
  /** Where the face has a landmark; close-ups look at them. */
  placeOf: PlaceOfLandmark;
  /** The turntable began, or ended. */
  onTurning?: (turning: boolean) => void;
  /** The camera stands elsewhere, or is about to. */
  onMoved: () => void;
}

export class Viewpoint {
  readonly camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.05, 5);
  /** What it looks at. */
  readonly target = new Vector3();
  private readonly controls: OrbitControls | null;
  private turning = false;
  private steppedAt = 0;
  private view: string;
  private shot: Shot;
  /** Degrees aside at which the camera stands, on its way to its view. */
  private angle: number;
  private glide: { from: number; to: number; start: number; duration: number } | null = null;
  /** The camera stands where a view put it, so that resizing may frame it anew. */
  private framed = true;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly options: ViewpointOptions,
  ) {
    this.view = options.view;
    this.shot = shotOf(this.view, options.placeOf);
    this.angle = this.shot.angle;
    this.controls = options.orbit ? this.createControls() : null;
  }

  /** Go on with what is under way: a walk to another view, the turntable. */
  step(now: number): void {
    this.stepGlide(now);
    this.stepTurntable(now);
  }

  /** See through a window of this shape [CSS px]. */
  fit(width: number, height: number): void {
    this.camera.aspect = width / height;
    if (this.options.orbit) {
      this.camera.setViewOffset(width, height, 0, -BAR_HEIGHT / 2, width, height);
    }
    this.camera.updateProjectionMatrix();
    if (this.framed) this.frame();
  }

  /** How far around the head the camera stands [radians]. */
  get around(): number {
    const { x, z } = this.offset();
    return Math.atan2(x, z);
  }

  dispose(): void {
    this.controls?.dispose();
  }

  /** Go round the head, until told not to, or until somebody takes the camera in hand. */
  setTurning(turning: boolean): void {
    if (turning === this.turning) return;
    this.turning = turning;
    this.steppedAt = performance.now();
    this.options.onTurning?.(turning);
    this.options.onMoved();
  }

  /**
   * Stand at a view: a name of views.ts, or degrees aside.
   * @throws Error when there is none of that name.
   */
  setView(view: string | number): void {
    this.shot = shotOf(String(view), this.options.placeOf);
    this.view = String(view);
    this.angle = this.shot.angle;
    this.glide = null;
    this.frame();
    this.options.onMoved();
  }

  /** The face has changed: its landmarks may lie elsewhere. */
  reframe(): void {
    if (!this.framed || this.glide !== null) return;
    this.shot = shotOf(this.view, this.options.placeOf);
    this.frame();
    this.options.onMoved();
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
    this.options.onMoved();
  }

  private stepTurntable(now: number): void {
    if (!this.turning || this.glide !== null) return;
    const degrees = (TURNTABLE_SPEED * Math.min(now - this.steppedAt, LONGEST_STEP_MS)) / 1000;
    this.steppedAt = now;
    const offset = this.offset().applyAxisAngle(UP, (degrees * Math.PI) / 180);
    this.camera.position.copy(this.target).add(offset);
    this.camera.lookAt(this.target);
    this.framed = false;
    this.options.onMoved();
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
      this.options.onMoved();
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
      this.options.onMoved();
    });
    return controls;
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
