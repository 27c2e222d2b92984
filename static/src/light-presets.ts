// How the studio may be lit: where lamps and soft boxes stand, and how bright they are.

type Triple = readonly [number, number, number];

interface Lamp {
  color: number;
  intensity: number;
  /** Where it stands from the middle of the head, when the camera is in front [m]. */
  from: Triple;
}

/** A bright rectangle that skin and eyes mirror; it faces the head. */
export interface SoftBox {
  from: Triple;
  size: readonly [number, number];
  radiance: number;
}

export interface LightPreset {
  label: string;
  /** The lamp that throws the shadow, and how dark that is, 0 to 1. */
  key: Lamp & { shadow: number };
  /** From about the camera's other side, and from behind on both sides. */
  fill: Lamp;
  rims: readonly [Lamp, Lamp];
  /** From above and below everywhere. */
  sky: { above: number; below: number; intensity: number };
  room: { walls: number; boxes: readonly SoftBox[]; intensity: number };
}

const BOXES: readonly SoftBox[] = [
  { from: [-4, 3.8, 5], size: [3.2, 3.6], radiance: 12 },
  { from: [5.4, 0.4, 3.6], size: [1.6, 5], radiance: 3.4 },
  { from: [0, 7, 0.5], size: [6, 4], radiance: 3.2 },
  { from: [0, -6, 3], size: [7, 3], radiance: 0.9 },
  { from: [5, 2, -5], size: [2.2, 5], radiance: 5 },
  { from: [-5.4, 2, -5], size: [1.8, 5], radiance: 3.2 },
];

/** From so far behind, these touch only edges, and no shadow of theirs is missed. */
const RIM_LEFT: Triple = [0.26, 0.16, -0.36];
const RIM_RIGHT: Triple = [-0.28, 0.12, -0.36];

export const LIGHTS = {
  studio: {
    label: 'Studio',
    // Some of the key's light comes back from the room, also where it does not reach.
    key: { color: 0xfff4ea, intensity: 2.8, from: [-0.215, 0.25, 0.35], shadow: 0.8 },
    fill: { color: 0xe6ebf7, intensity: 0.36, from: [0.36, 0.02, 0.3] },
    rims: [
      { color: 0xeef2fa, intensity: 0.9, from: RIM_LEFT },
      { color: 0xffecd8, intensity: 0.7, from: RIM_RIGHT },
    ],
    sky: { above: 0xeceef4, below: 0x8a6a5a, intensity: 0.1 },
    room: { walls: 0x2a2b2e, boxes: BOXES, intensity: 0.24 },
  },
  daylight: {
    label: 'Daylight',
    key: { color: 0xfffaf2, intensity: 2.1, from: [0.16, 0.34, 0.3], shadow: 0.6 },
    fill: { color: 0xd6e4f8, intensity: 0.7, from: [-0.36, 0.1, 0.28] },
    rims: [
      { color: 0xe4eefc, intensity: 0.7, from: RIM_LEFT },
      { color: 0xe4eefc, intensity: 0.7, from: RIM_RIGHT },
    ],
    sky: { above: 0xdce8f8, below: 0xa08f78, intensity: 0.7 },
    room: {
      walls: 0x4c555e,
      boxes: [
        { from: [0, 7, 2.5], size: [9, 7], radiance: 6 },
        { from: [4, 3.6, 5], size: [3.6, 3.6], radiance: 7 },
        { from: [0, -6, 3], size: [9, 4], radiance: 1.4 },
      ],
      intensity: 0.34,
    },
  },
  window: {
    label: 'Window',
    // A tall one at its right, and a dark room: half of the face lies in shade.
    key: { color: 0xfff1e0, intensity: 3.3, from: [-0.42, 0.1, 0.17], shadow: 0.95 },
    fill: { color: 0xcfd9ea, intensity: 0.12, from: [0.36, 0.02, 0.3] },
    rims: [
      { color: 0xdfe6f2, intensity: 0.35, from: RIM_LEFT },
      { color: 0xfff1e0, intensity: 0.6, from: RIM_RIGHT },
    ],
    sky: { above: 0xd8dde6, below: 0x6c564a, intensity: 0.06 },
    room: {
      walls: 0x1d1e21,
      boxes: [
        { from: [-6, 1.5, 2.6], size: [3, 6], radiance: 14 },
        { from: [5, 2, -5], size: [1.6, 4], radiance: 1.6 },
      ],
      intensity: 0.22,
    },
  },
  night: {
    label: 'Night',
    // Warm from one side behind, cold from the other; little in front.
    key: { color: 0xcfe0ff, intensity: 0.9, from: [-0.16, 0.2, 0.38], shadow: 0.9 },
    fill: { color: 0x8fa8d8, intensity: 0.2, from: [0.36, 0.02, 0.3] },
    rims: [
      { color: 0x9fc0ff, intensity: 2.8, from: RIM_LEFT },
      { color: 0xffb37a, intensity: 2.6, from: RIM_RIGHT },
    ],
    sky: { above: 0x8094c0, below: 0x5a4238, intensity: 0.1 },
    room: {
      walls: 0x16181d,
      boxes: [
        { from: [-3, 3.2, 5.4], size: [1.6, 1.6], radiance: 8 },
        { from: [5, 2, -5], size: [2.2, 5], radiance: 7 },
        { from: [-5.4, 2, -5], size: [1.8, 5], radiance: 6 },
      ],
      intensity: 0.18,
    },
  },
  even: {
    label: 'Even',
    // For measuring and comparing: no side of it is darker than the other.
    key: { color: 0xffffff, intensity: 1.5, from: [0, 0.16, 0.44], shadow: 0.35 },
    fill: { color: 0xffffff, intensity: 0.5, from: [0, -0.12, 0.42] },
    rims: [
      { color: 0xffffff, intensity: 0.35, from: RIM_LEFT },
      { color: 0xffffff, intensity: 0.35, from: RIM_RIGHT },
    ],
    sky: { above: 0xffffff, below: 0xc8bcb2, intensity: 0.8 },
    room: {
      walls: 0x54565a,
      boxes: [
        { from: [-5, 2, 4.5], size: [3, 4], radiance: 4.5 },
        { from: [5, 2, 4.5], size: [3, 4], radiance: 4.5 },
        { from: [0, 7, 1], size: [7, 5], radiance: 3 },
      ],
      intensity: 0.3,
    },
  },
} as const satisfies Record<string, LightPreset>;

export type LightName = keyof typeof LIGHTS;
export const LIGHT_NAMES = Object.keys(LIGHTS) as LightName[];

/** Tell whether a text names a way of lighting. */
export function isLight(name: string): name is LightName {
  return name in LIGHTS;
}
