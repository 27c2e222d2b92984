// What the panels know of a rig, and how its action units and tissue numbers are put in order.

export interface ActionUnit {
  name: string;
  title: string;
  source: string;
  /** Moves a side of its own, so that L and R can differ. */
  paired: boolean;
  /** Words that it is found by: number, name, muscles. */
  words: string;
}

export interface ActionUnitGroup {
  title: string;
  units: ActionUnit[];
}

export interface Muscle {
  name: string;
  kind: string;
  /** Editable numbers of the muscle by name, e.g. force_scale. */
  fields: Record<string, number>;
}

export interface Emotion {
  name: string;
  recipe: string;
  source: string;
}

/** Lowest and highest value of each pose axis, e.g. limits.jaw.pitch. */
export type Limits = Record<string, Record<string, [number, number]>>;

export interface Rig {
  id: string;
  name: string;
  groups: ActionUnitGroup[];
  muscles: Muscle[];
  emotions: Emotion[];
  tissue: TissueField[];
  /** What single regions have otherwise than the rest, by `region_laxity.cheek.L`. */
  regions: Record<string, number>;
  limits: Limits;
}

/** One number of the tissue, and the keys that lead to it. */
export interface TissueField {
  path: string[];
  value: number;
}

interface Described {
  id: string;
  name: string;
  muscles: { name: string; kind?: string; force_scale?: number; strength?: number }[];
  action_units: {
    name: string;
    title?: string;
    region?: string;
    source?: string;
    muscles?: unknown;
    one_sided?: boolean;
    description?: string;
  }[];
  limits: Limits;
  emotions: { name: string; recipe?: string; source?: string }[];
  tissue: Record<string, unknown>;
}

const GROUPS = [
  'Upper face',
  'Lids',
  'Lower face',
  'Cheeks',
  'Jaw',
  'Tongue',
  'Gaze',
  'Head',
] as const;
/** Group of each region that a rig names. */
const REGIONS: Record<string, (typeof GROUPS)[number]> = {
  upper: 'Upper face',
  lids: 'Lids',
  lower: 'Lower face',
  cheeks: 'Cheeks',
  jaw: 'Jaw',
  tongue: 'Tongue',
  gaze: 'Gaze',
  head: 'Head',
};
const LID_UNITS = [5, 6, 7, 41, 42, 43, 44, 45, 46];
const JAW_UNITS = [26, 27, 29, 30, 31];
/** Units of the midline: one muscle, or a jaw, cannot do them on one side. */
const MIDLINE_UNITS = [...JAW_UNITS, 8, 17, 18, 19, 22, 23, 24, 25, 28, 34, 35];
const MUSCLE_FIELDS = ['force_scale', 'strength'] as const;

export function describeRig(described: Described): Rig {
  return {
    id: described.id,
    name: described.name,
    groups: groupUnits(
      described.action_units,
      described.muscles.map(({ name }) => name),
    ),
    muscles: described.muscles.map(describeMuscle),
    emotions: described.emotions.map((emotion) => ({
      name: emotion.name,
      recipe: typeof emotion.recipe === 'string' ? emotion.recipe : '',
      source: emotion.source ?? '',
    })),
    tissue: tissueFields(described.tissue),
    regions: regionValues(described.tissue),
    limits: described.limits,
  };
}

function groupUnits(units: Described['action_units'], muscleNames: string[]): ActionUnitGroup[] {
  const groups = GROUPS.map((title) => ({ title, units: [] as ActionUnit[] }));
  for (const unit of units) {
    const number = unitNumber(unit.name);
    groups[GROUPS.indexOf(groupOf(number, unit.region))]!.units.push({
      name: unit.name,
      title: unit.title ?? '',
      source: [unit.description, unit.source].filter(Boolean).join(' — '),
      paired:
        unit.one_sided === true ||
        (Number.isFinite(number) && isPaired(unit.muscles, number, muscleNames)),
      words: [unit.name, unit.title ?? '', ...namesIn(unit.muscles).map(readable)]
        .join(' ')
        .toLowerCase(),
    });
  }
  for (const group of groups) group.units.sort((a, b) => unitNumber(a.name) - unitNumber(b.name));
  return groups.filter((group) => group.units.length > 0);
}

function namesIn(mapping: unknown): string[] {
  return typeof mapping === 'object' && mapping !== null ? Object.keys(mapping) : [];
}

/** The groups with those of their units that have every word of `sought`; a number is a whole one. */
export function unitsFound(groups: readonly ActionUnitGroup[], sought: string): ActionUnitGroup[] {
  const words = sought.toLowerCase().split(/\s+/).filter(Boolean);
  const has = (unit: ActionUnit, word: string): boolean =>
    /^\d+$/.test(word) ? unitNumber(unit.name) === Number(word) : unit.words.includes(word);
  return groups
    .map(({ title, units }) => ({
      title,
      units: units.filter((unit) => words.every((word) => has(unit, word))),
    }))
    .filter(({ units }) => units.length > 0);
}

/** Whether a unit has a muscle on either side; where the rig does not say, by the unit's number. */
function isPaired(muscles: unknown, number: number, muscleNames: string[]): boolean {
  if (typeof muscles !== 'object' || muscles === null) return !MIDLINE_UNITS.includes(number);
  return Object.keys(muscles).some((stem) => muscleNames.includes(`${stem}.L`));
}

function groupOf(number: number, region: string | undefined): (typeof GROUPS)[number] {
  const named = region?.toLowerCase() ?? '';
  const known = REGIONS[named];
  if (known !== undefined) return known;
  if (JAW_UNITS.includes(number) || named.includes('jaw')) return 'Jaw';
  if (LID_UNITS.includes(number) || named.includes('lid') || named.includes('eye')) return 'Lids';
  if (number <= 4 || named.includes('upper') || named.includes('brow')) return 'Upper face';
  return 'Lower face';
}

export function unitNumber(name: string): number {
  const digits = /\d+/.exec(name);
  return digits === null ? Infinity : Number(digits[0]);
}

/** `AU12` on one side is `L12` or `R12`. */
export function sideName(name: string, side: 'L' | 'R'): string {
  return side + name.replace(/^AU/, '');
}

function describeMuscle(muscle: Described['muscles'][number]): Muscle {
  const fields: Record<string, number> = {};
  for (const field of MUSCLE_FIELDS) {
    const value = muscle[field];
    if (typeof value === 'number') fields[field] = value;
  }
  return { name: muscle.name, kind: muscle.kind ?? '', fields };
}

/** Tissue numbers that are worth a slider; the others are in the API. */
const TISSUE_FIELDS = [
  'stiffness_low',
  'stiffness_high',
  'damping',
  'strain_threshold',
  'pretension',
  'compression_guard',
  'anchor_tangential',
  'anchor_normal',
  'fat_pressure',
];

/** The shown numbers in the tissue's description; a layered one gives a field per layer. */
export function tissueFields(tissue: Record<string, unknown>): TissueField[] {
  return TISSUE_FIELDS.flatMap((name) => {
    const value = tissue[name];
    const layers = typeof value === 'object' && value !== null ? Object.entries(value) : [];
    return [
      [name, value] as const,
      ...layers.map(([layer, number]) => [name, layer, number] as const),
    ]
      .map((parts) => ({ path: parts.slice(0, -1) as string[], value: parts.at(-1) as unknown }))
      .filter((field): field is TissueField => typeof field.value === 'number' && field.value > 0);
  });
}

/** What a region may have otherwise than the rest, and what the rest has. */
export const REGION_FIELDS = [
  { name: 'region_stiffness', label: 'Stiffness', rest: 1 },
  { name: 'region_thickness', label: 'Thickness', rest: 1 },
  { name: 'region_laxity', label: 'Laxity', rest: 0 },
  { name: 'region_pretension', label: 'Pretension', rest: 1 },
] as const;

function regionValues(tissue: Record<string, unknown>): Record<string, number> {
  return Object.fromEntries(
    REGION_FIELDS.flatMap(({ name }) =>
      Object.entries((tissue[name] ?? {}) as Record<string, number>).map(([region, value]) => [
        `${name}.${region}`,
        value,
      ]),
    ),
  );
}

/** `{dermis: {stiffness_low: 20}}` for the path of one field: a PATCH that names only that. */
export function tissuePatch(path: readonly string[], value: number): Record<string, unknown> {
  return path.reduceRight<unknown>((inner, key) => ({ [key]: inner }), value) as Record<
    string,
    unknown
  >;
}

/** `zygomatic_major.L` reads "Zygomatic major". */
export function readable(name: string): string {
  const words = name.replace(/\.[LR]$/, '').replaceAll('_', ' ');
  return words.charAt(0).toUpperCase() + words.slice(1);
}

/** The same, with the side that a paired one is of. */
export function sided(name: string): string {
  const side = { L: ', left', R: ', right' }[/\.([LR])$/.exec(name)?.[1] ?? ''] ?? '';
  return readable(name) + side;
}

/** FACS letter of an intensity: A to E in fifths, nothing at rest. */
export function intensityLetter(value: number): string {
  return value < 0.005
    ? ''
    : 'ABCDE'.charAt(Math.min(4, Math.max(0, Math.ceil(value * 5 - 1e-6) - 1)));
}
