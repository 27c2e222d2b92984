// The stage: renderer, camera and views; draws only when something has changed.

import type { Object3D } from 'three';
import {
  ACESFilmicToneMapping,
  PCFShadowMap,
  PerspectiveCamera,
  Scene as ThreeScene,
  Vector3,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { createBackdrop, createEnvironment, createLights } from './lights';

/** Lashes are thinner than a pixel: below this they fall apart into dots. */
const LEAST_PIXEL_RATIO = 1.5;
/** Share of the camera's way around the face that the lights go with it. */
const LIGHTS_FOLLOW = 0.8;
/** Degrees and time of the camera's way to its first view. */
const ENTER_FROM = 38;
const ENTER_MS = 1800;
/** How long the camera takes from one view to another [ms]. */
const GLIDE_MS = 900;
/** Height of the bar over the stage, whose half the head makes room for [CSS px]. */
const BAR_HEIGHT = 40;

/** Degrees that the camera stands to the face's left of straight in front. */
const VIEW_ANGLES: Record<string, number> = { front: 0, 'three-quarter': 35, profile: 90 };
/** A longer lens would flatten the face, a wider one spoils it [degrees]. */
const FIELD_OF_VIEW = 22;
const TARGET = new Vector3(0, -0.026, 0.012);
const ELEVATION = (2 * Math.PI) / 180;
/** What must be seen around the target [m], half of it: the head, and some air. */
const HALF_HEIGHT = 0.152;
const HALF_WIDTH = 0.122;

export interface SceneOptions {
  /** Let the visitor turn the camera. */
  orbit: boolean;
  pixelRatio: number | null;
  view: string;
  /** Take in what is new, e.g. the newest frame; tells whether it changed anything that is drawn. */
  update: () => boolean;
}

export class Scene {
  framesDrawn = 0;
  private readonly renderer: WebGLRenderer;
  private readonly scene = new ThreeScene();
  private readonly camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.05, 5);
  private readonly controls: OrbitControls | null;
  private readonly observer: ResizeObserver;
  private readonly lights = createLights();
  private view: string;
  /** Degrees aside at which the camera stands, on its way to its view. */
  private angle: number;
  private glide: { from: number; to: number; start: number; duration: number } | null = null;
  /** The camera stands where a view put it, so that resizing may frame it anew. */
  private framed = true;
  private scheduled = false;
  private changed = false;
  private waiting: (() => void)[] = [];

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly options: SceneOptions,
  ) {
    this.view = options.view;
    this.angle = VIEW_ANGLES[this.view]!;
    this.renderer = new WebGLRenderer({
      canvas,
      antialias: true,
      powerPreference: 'high-performance',
    });
    this.renderer.toneMapping = ACESFilmicToneMapping;
    this.renderer.toneMappingExposure = 1.0;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.renderer.setPixelRatio(
      options.pixelRatio ?? Math.min(Math.max(window.devicePixelRatio, LEAST_PIXEL_RATIO), 2),
    );
    this.scene.add(createBackdrop(), this.lights);
    this.scene.environment = createEnvironment(this.renderer);
    this.scene.environmentIntensity = 0.36;
    this.controls = options.orbit ? this.createControls() : null;
    this.observer = new ResizeObserver(() => {
      this.resize();
    });
    this.observer.observe(canvas);
    canvas.addEventListener('webglcontextrestored', () => {
      this.invalidate();
    });
    this.resize();
  }

  add(object: Object3D): void {
    this.scene.add(object);
    this.invalidate();
  }

  setView(name: string): void {
    if (!(name in VIEW_ANGLES)) {
      throw new Error(
        `There is no view "${name}"; known are ${Object.keys(VIEW_ANGLES).join(', ')}.`,
      );
    }
    this.view = name;
    this.angle = VIEW_ANGLES[name]!;
    this.glide = null;
    this.frame();
    this.invalidate();
  }

  /** Go round to a view, as someone would who walks about the head; at once for who wants no motion. */
  glideTo(name: string, from = this.standing(), duration = GLIDE_MS): void {
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
      const updated = this.options.update();
      if (updated || this.changed) this.draw();
    });
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
    const { x, z } = this.camera.position.clone().sub(TARGET);
    return (Math.atan2(x, z) * 180) / Math.PI;
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

  private draw(): void {
    this.changed = false;
    this.turnLights();
    this.renderer.render(this.scene, this.camera);
    this.framesDrawn++;
    const waiting = this.waiting;
    this.waiting = [];
    for (const resolve of waiting) resolve();
  }

  private turnLights(): void {
    const from = this.camera.position;
    const angle = Math.atan2(from.x - TARGET.x, from.z - TARGET.z) * LIGHTS_FOLLOW;
    this.lights.rotation.y = angle;
    this.scene.environmentRotation.y = angle;
  }

  private createControls(): OrbitControls {
    const controls = new OrbitControls(this.camera, this.canvas);
    controls.target.copy(TARGET);
    controls.minDistance = 0.36;
    controls.maxDistance = 2.2;
    controls.enablePan = false;
    controls.rotateSpeed = 0.7;
    controls.minPolarAngle = 0.25 * Math.PI;
    controls.maxPolarAngle = 0.72 * Math.PI;
    controls.addEventListener('start', () => {
      this.framed = false;
      this.glide = null;
    });
    controls.addEventListener('change', () => {
      this.invalidate();
    });
    return controls;
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    if (this.options.orbit) {
      this.camera.setViewOffset(
        clientWidth,
        clientHeight,
        0,
        -BAR_HEIGHT / 2,
        clientWidth,
        clientHeight,
      );
    }
    this.camera.updateProjectionMatrix();
    if (this.framed) this.frame();
    this.invalidate();
  }

  /** Stand where the whole head fits, whatever the window's shape. */
  private frame(): void {
    const angle = (this.angle * Math.PI) / 180;
    const slope = Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
    const distance = Math.max(HALF_HEIGHT / slope, HALF_WIDTH / (slope * this.camera.aspect));
    this.camera.position
      .set(
        Math.sin(angle) * Math.cos(ELEVATION),
        Math.sin(ELEVATION),
        Math.cos(angle) * Math.cos(ELEVATION),
      )
      .multiplyScalar(distance)
      .add(TARGET);
    this.camera.lookAt(TARGET);
    this.controls?.update();
    this.framed = true;
  }
}
