// What a person can be asked to look like, and how the panel orders it.

import type { AttributeInfo } from '../recipe';

export interface Attribute extends AttributeInfo {
  name: string;
}

export interface AttributeGroup {
  title: string;
  attributes: Attribute[];
}

const GROUPS: readonly (readonly [string, readonly string[]])[] = [
  ['Person', ['age', 'sex', 'weight']],
  ['Complexion', ['skin', 'undertone', 'freckles', 'stubble']],
  ['Eyes and hair', ['eye_color', 'hair_color', 'hair_style', 'grayness']],
  ['Shape, in standard deviations', []],
];
/** Chosen by chance, or by whoever sends a recipe. */
const NOT_SHOWN = ['seed', 'asymmetry'];

export function attributeGroups(attributes: Record<string, AttributeInfo>): AttributeGroup[] {
  const named = new Set<string>(GROUPS.flatMap(([, names]) => names));
  const rest = Object.keys(attributes).filter(
    (name) => !named.has(name) && !NOT_SHOWN.includes(name),
  );
  return GROUPS.map(([title, names]) => ({
    title,
    attributes: (names.length > 0 ? names : rest)
      .filter((name) => name in attributes)
      .map((name) => ({ name, ...attributes[name]! })),
  })).filter((group) => group.attributes.length > 0);
}

/** How a value is written: years whole, everything else with a sign where zero is the middle. */
export function written(attribute: Attribute, value: number): string {
  if (attribute.name === 'age') return value.toFixed(0);
  if (attribute.name === 'sex' && (value === 0 || value === 1)) return value ? 'Male' : 'Female';
  const centred = (attribute.range?.[0] ?? 0) < 0;
  return (centred && value > 0 ? '+' : '') + value.toFixed(attribute.name === 'sex' ? 2 : 1);
}
