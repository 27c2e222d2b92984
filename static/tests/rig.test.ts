// What the panels make of a rig's description.

import { describe, expect, it } from 'vitest';
import {
  describeRig,
  intensityLetter,
  readable,
  tissueFields,
  tissuePatch,
} from '../src/state/rig';
import { readPageOptions } from '../src/url';

const RIG = {
  id: 'abc',
  name: 'standard',
  muscles: [
    { name: 'zygomatic_major.L', kind: 'linear', force_scale: 1100, strength: 1.8 },
    { name: 'zygomatic_major.R', kind: 'linear', force_scale: 1100, strength: 1.8 },
    { name: 'orbicularis_oris', kind: 'sphincter', force_scale: 530 },
  ],
  action_units: [
    { name: 'AU26', title: 'Jaw drop', region: 'jaw', muscles: {} },
    { name: 'AU12', title: 'Lip corner puller', region: 'lower', muscles: { zygomatic_major: 1 } },
    { name: 'AU10', title: 'Upper lip raiser' },
    { name: 'AU18', title: 'Lip pucker', region: 'lower', muscles: { orbicularis_oris: 1 } },
    { name: 'AU1', title: 'Inner brow raiser', region: 'upper' },
    { name: 'AU43', title: 'Eyes closed', region: 'lids' },
  ],
  emotions: [{ name: 'happiness', recipe: '6D+12E' }],
  tissue: {
    stiffness_low: { epidermis: 50, dermis: 20 },
    damping: 40,
    pretension: 0,
    reference_length: 8,
    cross_diagonals: true,
  },
  limits: {},
};

describe('describeRig', () => {
  const rig = describeRig(RIG);

  it('groups units from the brow down, in order of their numbers', () => {
    expect(rig.groups.map(({ title, units }) => [title, units.map(({ name }) => name)])).toEqual([
      ['Upper face', ['AU1']],
      ['Lids', ['AU43']],
      ['Lower face', ['AU10', 'AU12', 'AU18']],
      ['Jaw', ['AU26']],
    ]);
  });

  it('lets sides differ only where a muscle has sides', () => {
    const paired = rig.groups.flatMap(({ units }) =>
      units.filter((unit) => unit.paired).map(({ name }) => name),
    );
    expect(paired).toEqual(['AU1', 'AU43', 'AU10', 'AU12']);
  });

  it('offers the numbers that a muscle has', () => {
    expect(rig.muscles.map(({ fields }) => Object.keys(fields))).toEqual([
      ['force_scale', 'strength'],
      ['force_scale', 'strength'],
      ['force_scale'],
    ]);
  });
});

describe('tissue', () => {
  it('shows the chosen numbers, by layer, and not the ones that are off', () => {
    expect(tissueFields(RIG.tissue)).toEqual([
      { path: ['stiffness_low', 'epidermis'], value: 50 },
      { path: ['stiffness_low', 'dermis'], value: 20 },
      { path: ['damping'], value: 40 },
    ]);
  });

  it('patches only what was edited', () => {
    expect(tissuePatch(['stiffness_low', 'dermis'], 33)).toEqual({ stiffness_low: { dermis: 33 } });
    expect(tissuePatch(['damping'], 20)).toEqual({ damping: 20 });
  });
});

describe('words', () => {
  it('reads intensities as FACS letters', () => {
    expect([0, 0.1, 0.2, 0.21, 0.6, 0.8, 1].map(intensityLetter)).toEqual([
      '',
      'A',
      'A',
      'B',
      'C',
      'D',
      'E',
    ]);
  });

  it('reads names', () => {
    expect(readable('zygomatic_major.L')).toBe('Zygomatic major');
  });
});

describe('readPageOptions', () => {
  it('has defaults, and refuses what it does not know', () => {
    expect(readPageOptions('')).toEqual({
      session: null,
      rig: 'standard',
      bare: false,
      embed: false,
      idle: true,
      still: false,
      sketch: false,
      view: 'front',
      light: 'studio',
      level: null,
      pixelRatio: null,
    });
    expect(readPageOptions('?session=../x&view=above&light=moon&dpr=99')).toMatchObject({
      session: null,
      view: 'front',
      light: 'studio',
      level: null,
      pixelRatio: null,
    });
  });

  it('reads what is asked', () => {
    expect(
      readPageOptions(
        '?session=a_1&rig=paper&bare=1&idle=0&still=1&draw=sketch&view=profile&light=window&dpr=1',
      ),
    ).toEqual({
      session: 'a_1',
      rig: 'paper',
      bare: true,
      embed: false,
      idle: false,
      still: true,
      sketch: true,
      view: 'profile',
      light: 'window',
      level: null,
      pixelRatio: 1,
    });
  });
});
