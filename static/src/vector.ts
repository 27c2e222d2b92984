// Points and ways in space, three numbers each.

export type Point = readonly [number, number, number];

export function between(from: Point, to: Point, share: number): Point {
  return plus(from, minus(to, from), share);
}

export function plus(point: Point, way: Point, times = 1): Point {
  return [point[0] + way[0] * times, point[1] + way[1] * times, point[2] + way[2] * times];
}

export function minus(one: Point, other: Point): Point {
  return plus(one, other, -1);
}

export function scaled(way: Point, times: number): Point {
  return [way[0] * times, way[1] * times, way[2] * times];
}

export function cross(one: Point, other: Point): Point {
  return [
    one[1] * other[2] - one[2] * other[1],
    one[2] * other[0] - one[0] * other[2],
    one[0] * other[1] - one[1] * other[0],
  ];
}

export function unit(way: Point): Point {
  return scaled(way, 1 / Math.max(1e-9, Math.hypot(...way)));
}

export function dot(one: Point, other: Point): number {
  return one[0] * other[0] + one[1] * other[1] + one[2] * other[2];
}
