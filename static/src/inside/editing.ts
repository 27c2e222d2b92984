// The form of a muscle as handles to be dragged, and what dragging one comes to. All in mm, head frame.

import type { MuscleForm, Point } from '../muscle-shape';
import { outward } from '../muscle-shape';
import { cross, dot, minus, plus, scaled, unit } from '../vector';

/** What a handle goes along: skin, skull, a line, the arc of an angle, or the plane of the picture. */
export type Along = 'skin' | 'bone' | 'line' | 'arc' | 'plane';

export interface Handle {
  /** Field of the muscle; of a sheet's ends with their number, e.g. `attachment.1`. */
  id: string;
  label: string;
  place: Point;
  along: Along;
}

export interface Ray {
  origin: Point;
  /** Of length 1. */
  direction: Point;
}

type Change = Partial<MuscleForm>;

/** A muscle reaches beyond its own length by at least this share. */
const LEAST_REACH = 1.02;
const MOST_REACH = 3;
const LEAST_ANGLE = 2;
const MOST_ANGLE = 88;
const LEAST_AXIS = 3;
const MOST_AXIS = 80;
const ARC_STEPS = 24;
const RING_STEPS = 48;
const DEGREES = 180 / Math.PI;

/** What an edit may change; of each kind of muscle some are there. */
const FIELDS = [
  'attachment',
  'insertion',
  'center',
  'radius',
  'angle',
  'semi_major',
  'semi_minor',
  'upper',
  'lower',
  'strength',
  'force_scale',
] as const;

/** Whether it is a muscle that can be in hand; air in the mouth is none. */
export function isMuscle({ kind }: MuscleForm): boolean {
  return kind === 'linear' || kind === 'sheet' || kind === 'sphincter' || kind === 'lid';
}

export function handlesOf(muscle: MuscleForm): Handle[] {
  const handle = (id: string, label: string, place: Point, along: Along): Handle => ({
    id,
    label,
    place,
    along,
  });
  if (muscle.kind === 'linear') {
    const { from, to, way, aside, length, angle, radius } = cone(muscle);
    return [
      handle('attachment', 'Attachment', from, 'bone'),
      handle('insertion', 'Insertion', to, 'skin'),
      handle('radius', 'Reach', plus(from, way, radius), 'line'),
      handle('angle', 'Angle', onArc(from, way, aside, 0.8 * length, angle), 'arc'),
    ];
  }
  if (muscle.kind === 'sheet') {
    const { from, way, radius } = sheetReach(muscle);
    const ends = (field: 'attachment' | 'insertion', along: Along): Handle[] =>
      (muscle[field] as readonly Point[]).map((place, at) =>
        handle(
          `${field}.${at}`,
          `${field === 'attachment' ? 'Attachment' : 'Insertion'} ${at + 1}`,
          place,
          along,
        ),
      );
    return [
      ...ends('attachment', 'bone'),
      ...ends('insertion', 'skin'),
      handle('radius', 'Reach', plus(from, way, radius), 'line'),
    ];
  }
  if (muscle.kind === 'sphincter') {
    const { middle, across, up } = ellipse(muscle);
    return [
      handle('center', 'Centre of pull', centerOf(muscle), 'plane'),
      handle('semi_major', 'Half width', plus(middle, across, muscle.semi_major!), 'line'),
      handle('semi_minor', 'Half height', plus(middle, up, muscle.semi_minor!), 'line'),
    ];
  }
  return [];
}

/** What the muscle becomes when a point handle is put at a place. */
export function placed(muscle: MuscleForm, id: string, place: Point): Change {
  const [field, number] = id.split('.') as ['attachment' | 'insertion' | 'center', string?];
  const rounded = place.map((value) => Math.round(100 * value) / 100) as unknown as Point;
  if (number === undefined) return reaching({ ...muscle, [field]: rounded }, { [field]: rounded });
  const ends = [...(muscle[field] as readonly Point[])];
  ends[Number(number)] = rounded;
  return { [field]: ends };
}

/**
 * What the muscle becomes when a handle that goes along a line or an arc is led by a ray.
 * @param rest the muscle at rest, where the one that is led is as a moving face carries it.
 */
export function led(muscle: MuscleForm, id: string, ray: Ray, rest = muscle): Change {
  if (id === 'angle') {
    const { from, way, aside, angle } = cone(muscle);
    const hit = onPlane(ray, from, cross(way, aside));
    if (hit === null) return { angle };
    const off = minus(hit, from);
    return {
      angle: clamped(DEGREES * Math.atan2(dot(off, aside), dot(off, way)), LEAST_ANGLE, MOST_ANGLE),
    };
  }
  if (id === 'radius') {
    const reach = muscle.kind === 'sheet' ? sheetReach : cone;
    const { from, way } = reach(muscle);
    const { length } = reach(rest);
    const most = MOST_REACH * length;
    return { radius: clamped(nearestOn(from, way, ray), LEAST_REACH * length, most) };
  }
  const { middle, across, up } = ellipse(muscle);
  const way = id === 'semi_major' ? across : up;
  return { [id]: clamped(nearestOn(middle, way, ray), LEAST_AXIS, MOST_AXIS) };
}

/** Lines that show where the muscle acts: each a row of points. */
export function zoneOf(muscle: MuscleForm): Point[][] {
  if (muscle.kind === 'linear') {
    const { from, to, way, aside, angle, radius } = cone(muscle);
    const arc = Array.from({ length: ARC_STEPS + 1 }, (_, at) =>
      onArc(from, way, aside, radius, angle * ((2 * at) / ARC_STEPS - 1)),
    );
    return [
      [from, to],
      [from, ...arc, from],
    ];
  }
  if (muscle.kind === 'sheet') {
    const [a, b] = muscle.attachment as readonly [Point, Point];
    const [c, d] = muscle.insertion as readonly [Point, Point];
    const { from, way, radius, length } = sheetReach(muscle);
    const end = plus(from, way, radius);
    const half = scaled(minus(d, c), 0.5);
    return [
      [a, b, d, c, a],
      [plus(from, way, length), end],
      [minus(end, half), plus(end, half)],
    ];
  }
  if (muscle.kind === 'sphincter') {
    const { middle, across, up } = ellipse(muscle);
    const ring = Array.from({ length: RING_STEPS + 1 }, (_, at) => {
      const angle = (2 * Math.PI * at) / RING_STEPS;
      const out = plus(middle, across, muscle.semi_major! * Math.cos(angle));
      return plus(out, up, muscle.semi_minor! * Math.sin(angle));
    });
    return [ring, [middle, centerOf(muscle)]];
  }
  return [];
}

/** The name of a muscle's other one; empty for one that is not paired. */
export function twinOf(muscle: string): string {
  const side = /\.([LR])$/.exec(muscle)?.[1];
  return side === undefined ? '' : `${muscle.slice(0, -1)}${side === 'L' ? 'R' : 'L'}`;
}

/** The muscle of the other side gets the same, mirrored. */
export function mirroredChange(change: Change): Change {
  const flip = (value: unknown): unknown => {
    if (!Array.isArray(value)) return value;
    if (Array.isArray(value[0])) return value.map(flip);
    const [x, y, z] = value as number[];
    return [-x!, y, z];
  };
  return Object.fromEntries(Object.entries(change).map(([name, value]) => [name, flip(value)]));
}

/** What of a change is an edit. */
export function fieldsOf(form: Change): Change {
  const there = FIELDS.filter((field) => form[field] !== undefined);
  return Object.fromEntries(there.map((field) => [field, form[field]]));
}

/** What edits change of a form, and what follows from that. */
export function formOf(form: Change): Change {
  const { jaw_share } = form;
  return { ...fieldsOf(form), ...(jaw_share === undefined ? {} : { jaw_share }) };
}

/** Where a ray meets the plane through a point; null where they are parallel. */
export function onPlane(ray: Ray, point: Point, normal: Point): Point | null {
  const slope = dot(ray.direction, normal);
  if (Math.abs(slope) < 1e-6) return null;
  return plus(ray.origin, ray.direction, dot(minus(point, ray.origin), normal) / slope);
}

function cone(muscle: MuscleForm): {
  from: Point;
  to: Point;
  way: Point;
  aside: Point;
  length: number;
  angle: number;
  radius: number;
} {
  const [from, to] = [muscle.attachment as Point, muscle.insertion as Point];
  const way = unit(minus(to, from));
  // In the plane of the skin over the muscle, so that the angle opens as it is seen.
  const aside = unit(cross(outward(scaled(plus(from, to), 0.5)), way));
  const length = Math.hypot(...minus(to, from));
  return {
    from,
    to,
    way,
    aside,
    length,
    angle: muscle.angle ?? 30,
    radius: muscle.radius ?? length,
  };
}

function sheetReach(muscle: MuscleForm): {
  from: Point;
  way: Point;
  length: number;
  radius: number;
} {
  const middle = (ends: readonly Point[]): Point => scaled(plus(ends[0]!, ends[1]!), 0.5);
  const from = middle(muscle.attachment as readonly Point[]);
  const whole = minus(middle(muscle.insertion as readonly Point[]), from);
  const length = Math.hypot(...whole);
  return { from, way: unit(whole), length, radius: muscle.radius ?? length };
}

function ellipse(muscle: MuscleForm): { middle: Point; across: Point; up: Point } {
  const out = unit(muscle.normal!);
  const across = unit(minus([1, 0, 0], scaled(out, out[0])));
  return { middle: muscle.plane!, across, up: cross(out, across) };
}

function centerOf(muscle: MuscleForm): Point {
  return muscle.center ?? muscle.plane!;
}

/** A linear muscle has to reach beyond its own insertion: a longer one takes its reach along. */
function reaching(muscle: MuscleForm, change: Change): Change {
  if (muscle.kind !== 'linear') return change;
  const { length, radius } = cone(muscle);
  return radius >= LEAST_REACH * length
    ? change
    : { ...change, radius: tenths(LEAST_REACH * length + 0.1) };
}

function onArc(from: Point, way: Point, aside: Point, radius: number, degrees: number): Point {
  const angle = degrees / DEGREES;
  return plus(plus(from, way, radius * Math.cos(angle)), aside, radius * Math.sin(angle));
}

/** How far along a line from a point lies what is nearest to a ray. */
function nearestOn(from: Point, way: Point, ray: Ray): number {
  const off = minus(from, ray.origin);
  const lean = dot(way, ray.direction);
  const level = 1 - lean * lean;
  if (level < 1e-6) return 0;
  return (lean * dot(off, ray.direction) - dot(off, way)) / level;
}

function clamped(value: number, least: number, most: number): number {
  return tenths(Math.min(most, Math.max(least, value)));
}

function tenths(value: number): number {
  return Math.round(10 * value) / 10;
}
