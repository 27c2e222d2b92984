// Colours of amounts: from none to most in even steps to the eye, also for who sees few colours (viridis, CC0).

const STOPS = [
  [68, 1, 84],
  [72, 40, 120],
  [62, 73, 137],
  [49, 104, 142],
  [38, 130, 142],
  [31, 158, 137],
  [53, 183, 121],
  [110, 206, 88],
  [181, 222, 43],
  [253, 231, 37],
] as const;
/** Early and late of a way: blue to red, as in the paper's Fig. 12. */
const EARLY = [46, 107, 255] as const;
const LATE = [255, 45, 45] as const;

export type Rgb = [number, number, number];

/** The colour of a share of the most, sRGB 0 to 255; beyond 0 and 1 the ends. */
export function rampColor(share: number): Rgb {
  const at = Math.min(1, Math.max(0, share)) * (STOPS.length - 1);
  const first = Math.min(STOPS.length - 2, Math.floor(at));
  return mixed(STOPS[first]!, STOPS[first + 1]!, at - first);
}

/** The colour of a time, from 0, the earliest, to 1. */
export function timeColor(share: number): Rgb {
  return mixed(EARLY, LATE, Math.min(1, Math.max(0, share)));
}

/** As a CSS image, from left to right. */
export function gradientOf(colorOf: (share: number) => Rgb): string {
  const stops = Array.from({ length: 10 }, (_, at) => `rgb(${colorOf(at / 9).join(' ')})`);
  return `linear-gradient(to right, ${stops.join(', ')})`;
}

/** Texels of the ramp, RGBA after RGBA. */
export function rampTexels(count: number): Uint8Array {
  const texels = new Uint8Array(4 * count);
  for (let at = 0; at < count; at++) texels.set([...rampColor(at / (count - 1)), 255], 4 * at);
  return texels;
}

function mixed(from: readonly number[], to: readonly number[], share: number): Rgb {
  return from.map((value, at) => Math.round(value + share * (to[at]! - value))) as Rgb;
}
