// Which level of detail a device is given, when its visitor does not say.

import { isSoftware } from './graphics';

export const LEVELS = ['low', 'medium', 'high'] as const;
export type Level = (typeof LEVELS)[number];

/** What a browser tells of the device it runs on. */
export interface Device {
  /** [GB], rounded down by the browser; null if it does not tell. */
  memory: number | null;
  /** Shorter side of the screen [CSS px]. */
  screen: number;
  /** The main pointer is a finger. */
  touch: boolean;
  /** What the graphics driver calls itself; empty if it does not tell. */
  graphics: string;
}

const LITTLE_MEMORY = 4;
const SMALL_SCREEN = 600;

/** Return the level to ask for: high, unless the device is small, weak, or has no graphics processor. */
export function levelFor(device: Device): Level {
  const small = device.screen < SMALL_SCREEN || device.touch;
  const weak = device.memory !== null && device.memory <= LITTLE_MEMORY;
  return small || weak || isSoftware(device.graphics) ? 'medium' : 'high';
}

/** A surface's address at a level; the high one is what the plain address gives. */
export function atLevel(address: string, level: Level): string {
  if (level === 'high') return address;
  const url = new URL(address);
  url.searchParams.set('level', level);
  return url.href;
}
