// A take as the service renders it: keyframes of a clip.

import type { Cue, Take } from './take';

export interface Keyframe {
  time: number;
  fade?: number;
  [field: string]: unknown;
}

export const FORMS = [
  { form: 'basis', label: 'Few targets', title: 'As few morph targets as keep within the error' },
  {
    form: 'arkit',
    label: "ARKit's",
    title: 'The 52 shapes of ARKit by name, fitted to each frame',
  },
  { form: 'exact', label: 'Exact', title: 'A morph target for each frame' },
] as const;
export const LEVELS = ['low', 'medium', 'high'] as const;

/** How the file of a clip is to be; see docs/clips.md. */
export interface ClipOptions {
  form: (typeof FORMS)[number]['form'];
  level: (typeof LEVELS)[number];
  fps: number;
  /** Largest error of any vertex with the form `basis` [mm]. */
  tolerance: number;
  textures: boolean;
  sparse: boolean;
}

/** As the service takes them where nothing is said. */
export const USUAL: ClipOptions = {
  form: 'basis',
  level: 'medium',
  fps: 30,
  tolerance: 0.1,
  textures: true,
  sparse: true,
};

/** The body of `POST /api/clips`, and the file of `risorius clip`. */
export interface Clip extends Partial<ClipOptions> {
  rig: string;
  fps: number;
  duration: number;
  timeline: Keyframe[];
}

const RELEASE_SECONDS = 0.2;
/** From one point among feelings to the next one. */
const FEELING_SECONDS = 0.15;

export function clipOf(take: Take, rig: string, fps = 30): Clip {
  const timeline = [...curves(take), ...take.cues.map(keyframeOf)];
  timeline.sort((one, other) => one.time - other.time);
  return { rig, fps, duration: rounded(take.duration), timeline };
}

/** A straight piece of a curve is a keyframe at its beginning that fades to its end. */
function curves({ tracks }: Take): Keyframe[] {
  const found = new Map<string, Keyframe>();
  const say = (time: number, fade: number, group: string, name: string, value: number): void => {
    const at = `${rounded(time)} ${rounded(fade)}`;
    const keyframe = found.get(at) ?? { time: rounded(time), fade: rounded(fade) };
    found.set(at, { ...keyframe, [group]: { ...(keyframe[group] as object), [name]: value } });
  };
  for (const { group, name, keys } of tracks) {
    if (keys[0] !== undefined && keys[0].value !== 0) say(0, 0, group, name, keys[0].value);
    keys.slice(1).forEach((key, index) => {
      const before = keys[index]!;
      if (key.value === before.value) return;
      say(before.time, key.time - before.time, group, name, key.value);
    });
  }
  return [...found.values()];
}

function keyframeOf({ time, plays }: Cue): Keyframe {
  const at = rounded(time);
  if (plays === null) return { time: at, layer: 'emotion', replace: true, fade: RELEASE_SECONDS };
  const fade = 'valence' in plays ? { fade_in: FEELING_SECONDS } : {};
  return { time: at, emotion: { ...plays, ...fade, seed: 0 } };
}

function rounded(seconds: number): number {
  return Math.round(1000 * seconds) / 1000;
}
