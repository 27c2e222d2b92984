// Where the camera may stand: named views of the head, close-ups at its landmarks, or so many degrees aside.

/** What the camera looks at; lengths in metres, in the head's frame at rest. */
export interface Shot {
  /** Degrees that the camera stands to the face's left of straight in front. */
  angle: number;
  target: readonly [number, number, number];
  /** What must be seen around the target, half of it. */
  halfHeight: number;
  halfWidth: number;
}

/** Views that a visitor is offered. */
export const VIEWS = ['front', 'three-quarter', 'profile'] as const;
/** Views for contact sheets and scripts besides. */
export const MORE_VIEWS = ['left', 'eye', 'mouth', 'ear'] as const;
export type ViewName = (typeof VIEWS)[number] | (typeof MORE_VIEWS)[number];

/** The head, and some air. */
const HEAD = { target: [0, -0.026, 0.012], halfHeight: 0.152, halfWidth: 0.122 } as const;

const ANGLES: Record<ViewName, number> = {
  front: 0,
  'three-quarter': 35,
  profile: 90,
  left: -90,
  eye: 14,
  mouth: 22,
  ear: 78,
};

interface CloseUp {
  /** Landmarks between which the target lies, and how far it stands off [m]. */
  between: readonly string[];
  off: readonly [number, number, number];
  half: number;
}

const CLOSE_UPS: Partial<Record<ViewName, CloseUp>> = {
  eye: { between: ['en.L', 'ex.L'], off: [0, 0.003, 0], half: 0.03 },
  mouth: { between: ['ch.L', 'ch.R', 'ls', 'li'], off: [0, 0.002, 0], half: 0.042 },
  // Beside the cheekbone, behind it.
  ear: { between: ['zy.L'], off: [0.004, 0.004, -0.036], half: 0.048 },
};

/** Gives a landmark's place [m, head frame]; null if the face has none of that name. */
export type PlaceOfLandmark = (name: string) => readonly [number, number, number] | null;

/** Tell whether a text names a view. */
export function isView(name: string): name is ViewName {
  return name in ANGLES;
}

/**
 * Return what the camera is to show for a view's name, or a number of degrees ("25", "-50").
 * A close-up of a face that has not its landmarks shows the head from there.
 * @throws Error when the name is not known.
 */
export function shotOf(view: string, placeOf: PlaceOfLandmark): Shot {
  const degrees = Number(view);
  if (view.trim() !== '' && Math.abs(degrees) <= 180) return { ...HEAD, angle: degrees };
  if (!isView(view)) {
    const known = [...VIEWS, ...MORE_VIEWS].join(', ');
    throw new Error(
      `There is no view "${view}"; known are ${known}, and degrees from -180 to 180.`,
    );
  }
  const angle = ANGLES[view];
  const closeUp = CLOSE_UPS[view];
  const target = closeUp === undefined ? null : middle(closeUp, placeOf);
  if (closeUp === undefined || target === null) return { ...HEAD, angle };
  return { angle, target, halfHeight: closeUp.half, halfWidth: closeUp.half };
}

function middle({ between, off }: CloseUp, placeOf: PlaceOfLandmark): Shot['target'] | null {
  const sum: [number, number, number] = [...off];
  for (const name of between) {
    const place = placeOf(name);
    if (place === null) return null;
    for (let axis = 0; axis < 3; axis++) sum[axis]! += place[axis]! / between.length;
  }
  return sum;
}
