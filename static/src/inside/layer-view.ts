// The layers under the skin: the net of the one that is peeled to, and the next sheet under it (the paper's Fig. 8).

import type { Object3D } from 'three';
import {
  BufferGeometry,
  Color,
  DoubleSide,
  DynamicDrawUsage,
  Float32BufferAttribute,
  Group,
  LineSegments,
  Mesh,
  ShaderMaterial,
} from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import type { Point } from '../vector';
import type { Outline } from './outline';
import { farFrom, outline } from './outline';
import { Section } from './section';
import { Skull } from './skull';

/** Layers that the skin can be peeled to, outermost first; bone has no net of its own. */
export const SHEETS = ['epidermis', 'dermis', 'hypodermis', 'bone'] as const;

/** Colours of the sheets, and of the springs over them, which are read against them. */
const FILL = ['#dcae8f', '#c9776a', '#e6c56c', '#e8e0cd'] as const;
const STRUCTURAL = '#20242a';
const SHEAR = '#0d7f86';

/** A sheet hides gums, teeth, eyeballs and the lids' flesh that come out of it by less than this [m]. */
const HIDES = 16e-3;
/** Its inner side, seen through mouth and lids, lies behind the walls of the mouth, which are drawn 30 mm deeper than they are [m]. */
const SINKS = 36e-3;

interface Springs {
  kind: 'structural' | 'shear' | 'tie';
  /** Sheets that they join. */
  from: number;
  to: number;
}

export class LayerView {
  readonly group = new Group();
  readonly skull: Skull;
  /** Nodes of a sheet. */
  readonly nodes: number;
  /** Where the sheets end, at rest [m]. */
  readonly outline: Outline;
  private readonly section: Section;
  private readonly rest: Float32Array;
  private readonly positions: Float32BufferAttribute;
  private readonly sheets: Mesh<BufferGeometry, ShaderMaterial>[] = [];
  private readonly nets: {
    springs: Springs;
    lines: LineSegments<BufferGeometry, ShaderMaterial>;
  }[] = [];
  private readonly cut = { value: 0 };
  /** Number of the sheet that is seen. */
  private reach = 0;
  /** Out of the face, at each node as the sheet that is seen has it. */
  private readonly outward: Float32BufferAttribute;

  /** @throws Error when the file cannot be had, or is of another form. */
  static async load(url: string): Promise<LayerView> {
    return new LayerView((await new GLTFLoader().loadAsync(url)).scene);
  }

  private constructor(scene: Object3D) {
    const found: { extras: Record<string, unknown>; geometry: BufferGeometry }[] = [];
    scene.traverse((node) => {
      const { role } = node.userData as { role?: string };
      if (role === 'sheet' || role === 'springs') {
        found.push({ extras: node.userData, geometry: (node as Mesh).geometry });
      }
    });
    const sheets = found.filter(({ extras }) => extras.role === 'sheet');
    sheets.sort((one, other) => Number(one.extras.sheet) - Number(other.extras.sheet));
    if (sheets.length !== SHEETS.length)
      throw new Error('The tissue file has other layers. Reload the page.');
    const places = sheets.map(
      ({ geometry }) => geometry.getAttribute('position').array as Float32Array,
    );
    this.nodes = places[0]!.length / 3;
    this.rest = new Float32Array(places.flatMap((place) => [...place]));
    this.positions = new Float32BufferAttribute(this.rest, 3);
    this.positions.setUsage(DynamicDrawUsage);
    const away = new Float32BufferAttribute(
      Float32Array.from({ length: this.rest.length / 3 }, (_, at) => this.rest[3 * at]!),
      1,
    );
    this.outward = new Float32BufferAttribute(new Float32Array(this.rest.length), 3);
    const triangles = Array.from(sheets[0]!.geometry.getIndex()!.array);
    const border = outline({ positions: places[0]!, triangles });
    const placeOf = (node: number): Point =>
      [0, 1, 2].map((axis) => places[0]![3 * node + axis]!) as unknown as Point;
    const ring = border.map(placeOf);
    const inset = farFrom(ring, places[0]!);
    this.outline = { ring, middle: placeOf(inset.indexOf(Math.max(...inset))) };
    const within = new Float32BufferAttribute(
      SHEETS.flatMap(() => [...inset]),
      1,
    );
    this.section = new Section(away.array.subarray(0, this.nodes), triangles, border, FILL);
    sheets.forEach(({ geometry }, at) => {
      const sheet = new BufferGeometry();
      sheet.setAttribute('position', this.positions);
      sheet.setAttribute('across', away);
      sheet.setAttribute('inset', within);
      sheet.setAttribute('outward', this.outward);
      sheet.setIndex(Array.from(geometry.getIndex()!.array, (node) => node + at * this.nodes));
      this.sheets.push(new Mesh(sheet, flesh(FILL[at]!, this.cut)));
    });
    for (const { extras, geometry } of found) {
      if (extras.role !== 'springs') continue;
      const springs = { kind: extras.kind, from: extras.from, to: extras.to } as Springs;
      const net = new BufferGeometry();
      net.setAttribute('position', this.positions);
      net.setAttribute('across', away);
      net.setAttribute('inset', within);
      net.setAttribute('outward', this.outward);
      net.setIndex(geometry.getIndex());
      const color = springs.kind === 'shear' ? SHEAR : STRUCTURAL;
      const lines = new LineSegments(
        net,
        thread(color, springs.from === springs.to ? 0.75 : 0.5, this.cut),
      );
      // Where springs lie over each other, those along the layer are seen, and structural ones first.
      lines.renderOrder =
        (springs.from === springs.to ? 2 : 0) + (springs.kind === 'shear' ? 0 : 1);
      this.nets.push({ springs, lines });
    }
    for (const drawn of [...this.sheets, ...this.nets.map(({ lines }) => lines)]) {
      drawn.frustumCulled = false;
      this.group.add(drawn);
    }
    this.skull = new Skull(sheets.at(-1)!.geometry);
    this.group.add(this.skull.mesh, this.section.mesh);
    this.peel(0, { structural: true, shear: true });
  }

  /** @param to 0 for skin, 1 for the first of `SHEETS`. */
  peel(to: number, shown: { structural: boolean; shear: boolean }): void {
    const top = to - 1;
    this.sheets.forEach((sheet, at) => {
      sheet.visible = to > 0 && at === Math.min(top + 1, SHEETS.length - 1);
    });
    this.turn();
    this.reach = to === 0 ? 0 : Math.min(to, SHEETS.length - 1);
    this.showSection();
    for (const { springs, lines } of this.nets) {
      const wanted = springs.kind === 'shear' ? shown.shear : shown.structural;
      lines.visible = to > 0 && wanted && springs.from === top;
    }
  }

  /** Show what lies further to the face's left than this [m]. */
  cutAt(x: number): void {
    this.cut.value = x;
    this.showSection();
  }

  /** @param moved of all nodes from rest [m], sheet by sheet, outermost first. */
  move(moved: Float32Array): void {
    const places = this.positions.array;
    for (let at = 0; at < places.length; at++) places[at] = this.rest[at]! + moved[at]!;
    this.positions.needsUpdate = true;
    this.section.move(places);
    this.turn();
  }

  private showSection(): void {
    this.section.show(this.reach, this.cut.value);
    this.section.move(this.positions.array);
  }

  /** Find which way the sheet that is seen looks now. */
  private turn(): void {
    this.sheets.forEach(({ visible, geometry }, at) => {
      if (!visible) return;
      geometry.computeVertexNormals();
      const size = 3 * this.nodes;
      const normals = geometry.getAttribute('normal').array.subarray(at * size, (at + 1) * size);
      for (let sheet = 0; sheet < SHEETS.length; sheet++)
        this.outward.array.set(normals, sheet * size);
      this.outward.needsUpdate = true;
    });
  }

  dispose(): void {
    this.group.removeFromParent();
    for (const { geometry, material } of [...this.sheets, ...this.nets.map(({ lines }) => lines)]) {
      geometry.dispose();
      material.dispose();
    }
    this.section.dispose();
    this.skull.dispose();
  }
}

type Cut = { value: number };

/** Draws a place where it is, and has it hide what is a little before it; but never skin, which the cut leaves on the other side. */
const OVER_FLESH = /* glsl */ `
  vec4 overFlesh(vec4 seen, vec3 normal, float beyond) {
    float hides = clamp(0.8 * beyond, 0.0, ${HIDES.toFixed(4)});
    float faces = dot(normalize(normal), normalize(-seen.xyz));
    hides = mix(${(-SINKS).toFixed(4)}, hides, smoothstep(-0.55, -0.3, faces));
    vec4 drawn = projectionMatrix * seen;
    vec4 nearer = projectionMatrix * vec4(seen.xyz * (1.0 - hides / length(seen.xyz)), 1.0);
    return vec4(drawn.xy, drawn.w * nearer.z / nearer.w, drawn.w);
  }`;

function flesh(color: string, cut: Cut): ShaderMaterial {
  return new ShaderMaterial({
    uniforms: { color: { value: new Color(color) }, cut },
    side: DoubleSide,
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
    vertexShader: /* glsl */ `
      attribute float across;
      attribute float inset;
      attribute vec3 outward;
      varying float vAcross;
      varying vec3 vNormal;
      uniform float cut;
      ${OVER_FLESH}
      void main() {
        vAcross = across;
        vNormal = normalMatrix * normal;
        gl_Position = overFlesh(modelViewMatrix * vec4(position, 1.0), normalMatrix * outward, min(across - cut, inset));
      }`,
    fragmentShader: /* glsl */ `
      // The inner side lies in the dark of the mouth, among flesh.
      const vec3 INNER = vec3(0.24, 0.07, 0.06);
      uniform vec3 color;
      uniform float cut;
      varying float vAcross;
      varying vec3 vNormal;
      void main() {
        if (vAcross < cut) discard;
        vec3 n = normalize(vNormal) * (gl_FrontFacing ? 1.0 : -1.0);
        float key = max(0.0, dot(n, normalize(vec3(-0.35, 0.5, 0.8))));
        float fill = max(0.0, dot(n, normalize(vec3(0.7, -0.1, 0.5))));
        gl_FragColor = vec4(color * (0.2 + 0.75 * key + 0.2 * fill) * (gl_FrontFacing ? vec3(1.0) : INNER), 1.0);
        #include <colorspace_fragment>
      }`,
  });
}

function thread(color: string, opacity: number, cut: Cut): ShaderMaterial {
  return new ShaderMaterial({
    uniforms: { color: { value: new Color(color) }, opacity: { value: opacity }, cut },
    transparent: true,
    depthWrite: false,
    vertexShader: /* glsl */ `
      attribute float across;
      attribute float inset;
      attribute vec3 outward;
      varying float vAcross;
      uniform float cut;
      ${OVER_FLESH}
      void main() {
        vAcross = across;
        gl_Position = overFlesh(modelViewMatrix * vec4(position, 1.0), normalMatrix * outward, min(across - cut, inset));
      }`,
    fragmentShader: /* glsl */ `
      uniform vec3 color;
      uniform float opacity;
      uniform float cut;
      varying float vAcross;
      void main() {
        if (vAcross < cut) discard;
        gl_FragColor = vec4(color, opacity);
        #include <colorspace_fragment>
      }`,
  });
}
