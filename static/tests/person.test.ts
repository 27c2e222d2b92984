import { describe, expect, it } from 'vitest';
import { attributeGroups, written } from '../src/state/person';

const ATTRIBUTES = {
  sex: { default: 1, range: [0, 1] as [number, number] },
  nose_width: { default: 0, range: [-3, 3] as [number, number] },
  eye_color: { default: 'hazel', choices: ['blue', 'hazel'] },
  seed: { default: 0 },
};

describe('a person', () => {
  it('is shown in groups, and what no group names is shape', () => {
    const groups = attributeGroups(ATTRIBUTES);
    expect(groups.map(({ attributes }) => attributes.map(({ name }) => name))).toEqual([
      ['sex'],
      ['eye_color'],
      ['nose_width'],
    ]);
  });

  it('has years in whole numbers and a sign on what lies about the norm', () => {
    expect(written({ name: 'age', default: 30, range: [18, 90] }, 41.2)).toBe('41');
    expect(written({ name: 'nose_width', ...ATTRIBUTES.nose_width }, 1.25)).toMatch(/^\+1\.[23]$/);
    expect(written({ name: 'skin', default: 0.2, range: [0, 1] }, 0.5)).toBe('0.5');
  });
});
