// Muscles as bundles of fibres to be drawn: where each fibre runs, and how much of it goes with the skin.

import type { Point } from './vector';
import { between, cross, minus, plus, scaled, unit } from './vector';

export type { Point } from './vector';

/** What the service says of a muscle's form, mm in the head's frame; lids and air have no fibres. */
export interface MuscleForm {
  name: string;
  kind?: string;
  /** Bone end; of a sheet a line of points. */
  attachment?: Point | readonly Point[];
  /** Skin end. */
  insertion?: Point | readonly Point[];
  /** Of a ring: the middle of its ellipse, the normal of that, and half its axes. */
  plane?: Point;
  normal?: Point;
  semi_major?: number;
  semi_minor?: number;
  /** Of a ring: where its fibres pull to. */
  center?: Point;
  /** How far it acts from its attachment [mm], and how wide [degrees]. */
  radius?: number;
  angle?: number;
  /** Of one that turns lids: by how much it turns the upper one down, and the lower one up [degrees]. */
  upper?: number;
  lower?: number;
  strength?: number;
  force_scale?: number;
  /** By how much of the jaw its bone end rides, 0 to 1. */
  jaw_share?: number;
}

/** A line through the flesh. */
export interface Fibre {
  points: Point[];
  /** How far each point goes with the skin, 0 on the bone to 1. */
  follows: number[];
  /** Half its thickness at each point [mm]. */
  radii: number[];
  /** By how much of the jaw its bone end rides. */
  rides: number;
  /** Whether each point goes with the skin over it; else all go with the skin at the last one. */
  spread: boolean;
}

const STEPS = 12;
const RING_STEPS = 48;
/** Fibres of a spindle, and how far apart they lie at either end [mm]. */
const SPINDLE = 5;
const SPREAD_AT_BONE = 2.4;
const SPREAD_AT_SKIN = 6;
/** Distance between the fibres of a sheet [mm]. */
const SHEET_GAP = 4.5;
/** Where the fibres of a ring run, as shares of its ellipse. */
const RINGS = [0.52, 0.68, 0.84];
const THIN = 0.35;
const THICK = 1.25;
/** Sheets without bone: they lie in the lip that they insert in, and all of them goes with it. */
const IN_LIPS = /^orbicularis_oris/;

export function fibresOf(muscle: MuscleForm): Fibre[] {
  switch (muscle.kind) {
    case 'linear':
      return spindle(muscle.attachment as Point, muscle.insertion as Point, muscle.jaw_share ?? 0);
    case 'sheet':
      return sheet(muscle);
    case 'sphincter':
      return RINGS.map((share) => ring(muscle, share));
    default:
      return [];
  }
}

function spindle(attachment: Point, insertion: Point, rides: number): Fibre[] {
  const along = unit(minus(insertion, attachment));
  const aside = unit(cross(outward(between(attachment, insertion, 0.5)), along));
  return Array.from({ length: SPINDLE }, (_, index) => {
    const off = (2 * index) / (SPINDLE - 1) - 1;
    return straight(
      plus(attachment, aside, (off * SPREAD_AT_BONE) / 2),
      plus(insertion, aside, (off * SPREAD_AT_SKIN) / 2),
      rides,
    );
  });
}

function sheet({ name, attachment, insertion }: MuscleForm): Fibre[] {
  const [from, to] = [attachment as readonly Point[], insertion as readonly Point[]];
  const count = Math.max(3, Math.round(lengthOf(to) / SHEET_GAP) + 1);
  return Array.from({ length: count }, (_, index) => {
    const share = index / (count - 1);
    const fibre = straight(onLine(from, share), onLine(to, share), 0);
    return IN_LIPS.test(name) ? { ...fibre, follows: fibre.follows.map(() => 1) } : fibre;
  });
}

/** A fibre that swells towards its middle. */
function straight(from: Point, to: Point, rides: number): Fibre {
  const shares = Array.from({ length: STEPS + 1 }, (_, index) => index / STEPS);
  return {
    points: shares.map((share) => bowed(from, to, share)),
    follows: shares,
    radii: shares.map((share) => THIN + (THICK - THIN) * Math.sin(Math.PI * share) ** 0.8),
    rides,
    spread: false,
  };
}

/** A straight line between two points of a round head runs deep: it is led out to their depth. */
function bowed(from: Point, to: Point, share: number): Point {
  const at = between(from, to, share);
  const wanted = fromAxis(from) + (fromAxis(to) - fromAxis(from)) * share;
  const short = Math.max(0, wanted - fromAxis(at));
  return plus(at, outward(at), short);
}

function ring({ plane, normal, semi_major: a, semi_minor: b }: MuscleForm, share: number): Fibre {
  const out = unit(normal!);
  const across = unit(minus([1, 0, 0], scaled(out, out[0])));
  const up = cross(out, across);
  const angles = Array.from({ length: RING_STEPS + 1 }, (_, at) => (2 * Math.PI * at) / RING_STEPS);
  return {
    points: angles.map((angle) =>
      plus(plus(plane!, across, share * a! * Math.cos(angle)), up, share * b! * Math.sin(angle)),
    ),
    follows: angles.map(() => 1),
    radii: angles.map(() => 0.8),
    rides: 0,
    spread: true,
  };
}

/** Away from the head's upright axis. */
export function outward([x, , z]: Point): Point {
  return unit([x, 0, z + 1e-6]);
}

function fromAxis([x, , z]: Point): number {
  return Math.hypot(x, z);
}

function onLine(points: readonly Point[], share: number): Point {
  const at = share * (points.length - 1);
  const first = Math.min(points.length - 2, Math.floor(at));
  return between(points[first]!, points[first + 1]!, at - first);
}

function lengthOf(points: readonly Point[]): number {
  return points
    .slice(1)
    .reduce((sum, point, index) => sum + Math.hypot(...minus(point, points[index]!)), 0);
}
