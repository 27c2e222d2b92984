// Ways of points over the skin, as lines from blue, the earliest, to red.

import { Color } from 'three';
import { LineMaterial } from 'three/addons/lines/LineMaterial.js';
import { LineSegments2 } from 'three/addons/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';
import { timeColor } from './ramp';
import type { Ways } from './trail';

/** CSS pixels. */
const WIDTH = 2.5;
/** So far the lines stand off the skin [m], or it would hide half of each. */
const OFF_SKIN = 1.2e-3;

export class TrailView {
  readonly lines: LineSegments2;

  /** @param rest points at rest [mm, head frame]. */
  constructor(private readonly rest: Float32Array) {
    const material = new LineMaterial({ vertexColors: true, linewidth: WIDTH });
    this.lines = new LineSegments2(new LineSegmentsGeometry(), material);
    this.lines.frustumCulled = false;
    this.lines.visible = false;
    // After skin and hair, which are partly blended.
    this.lines.renderOrder = 8;
  }

  show({ point, moved, late }: Ways): void {
    const places = new Float32Array(moved.length);
    const colors = new Float32Array(moved.length);
    const color = new Color();
    point.forEach((p, at) => {
      const [x, y, z] = [0, 1, 2].map((axis) => this.rest[3 * p + axis]! * 1e-3) as [
        number,
        number,
        number,
      ];
      const out = OFF_SKIN / Math.max(1e-6, Math.hypot(x, z));
      places.set([x * (1 + out), y, z * (1 + out)], 3 * at);
      for (let axis = 0; axis < 3; axis++) places[3 * at + axis]! += moved[3 * at + axis]!;
      const [red, green, blue] = timeColor(late[at]!);
      color.setRGB(red / 255, green / 255, blue / 255, 'srgb').toArray(colors, 3 * at);
    });
    this.lines.visible = point.length > 0;
    this.lines.geometry.dispose();
    this.lines.geometry = new LineSegmentsGeometry();
    if (point.length === 0) return;
    this.lines.geometry.setPositions(places);
    this.lines.geometry.setColors(colors);
  }

  dispose(): void {
    this.lines.removeFromParent();
    this.lines.geometry.dispose();
    this.lines.material.dispose();
  }
}
