// Handles of muscles, what dragging them comes to, and that only the newest edit is sent.

import { describe, expect, it } from 'vitest';
import type { MuscleEditingParts } from '../src/app/muscle-editing';
import { MuscleEditing } from '../src/app/muscle-editing';
import {
  atRest,
  carriedFibre,
  carriedHandles,
  carriedZone,
  ledAsCarried,
} from '../src/inside/carried';
import { handlesOf, led, mirroredChange, placed, twinOf, zoneOf } from '../src/inside/editing';
import { carrierOf, nearestPoint } from '../src/ground';
import { Newest } from '../src/inside/newest';
import type { MuscleForm, Point } from '../src/muscle-shape';
import { fibresOf } from '../src/muscle-shape';
import { rideOf, SHUT } from '../src/riding';
import { ViewerState } from '../src/state/viewer.svelte';

const LINEAR: MuscleForm = {
  name: 'zygomatic_major.L',
  kind: 'linear',
  attachment: [60, -20, 60],
  insertion: [30, -60, 60],
  radius: 70,
  angle: 20,
};
const SHEET: MuscleForm = {
  name: 'frontalis_medial.L',
  kind: 'sheet',
  attachment: [
    [0, 60, 90],
    [20, 60, 90],
  ],
  insertion: [
    [0, 20, 90],
    [20, 20, 90],
  ],
  radius: 50,
};
const RING: MuscleForm = {
  name: 'orbicularis_oris',
  kind: 'sphincter',
  center: [0, -70, 110],
  plane: [0, -70, 100],
  normal: [0, 0, 1],
  semi_major: 40,
  semi_minor: 20,
};

const placeOf = (muscle: MuscleForm, id: string): Point =>
  handlesOf(muscle).find((handle) => handle.id === id)!.place;
/** A line of sight along z through a place. */
const through = ([x, y]: Point) => ({ origin: [x, y, 500], direction: [0, 0, -1] }) as const;

describe('handles', () => {
  it('stand at the ends, at the reach and at the angle of a linear muscle', () => {
    expect(handlesOf(LINEAR).map(({ id, along }) => `${id} ${along}`)).toEqual([
      'attachment bone',
      'insertion skin',
      'radius line',
      'angle arc',
    ]);
    expect(placeOf(LINEAR, 'radius')).toEqual([18, -76, 60]);
  });

  it('of other kinds are their lines and axes; lids have none', () => {
    expect(handlesOf(SHEET).map(({ id }) => id)).toEqual([
      'attachment.0',
      'attachment.1',
      'insertion.0',
      'insertion.1',
      'radius',
    ]);
    expect(placeOf(RING, 'semi_major')).toEqual([40, -70, 100]);
    expect(handlesOf({ name: 'levator_palpebrae.L', kind: 'lid' })).toEqual([]);
    expect(zoneOf({ name: 'levator_palpebrae.L', kind: 'lid' })).toEqual([]);
  });

  it('that are put where they stand change nothing', () => {
    expect(placed(LINEAR, 'insertion', [30, -60, 60])).toEqual({ insertion: [30, -60, 60] });
    expect(led(LINEAR, 'radius', through(placeOf(LINEAR, 'radius')))).toEqual({ radius: 70 });
    expect(led(RING, 'semi_minor', through(placeOf(RING, 'semi_minor')))).toEqual({
      semi_minor: 20,
    });
    const angle = placeOf(LINEAR, 'angle');
    const out: Point = [Math.SQRT1_2, 0, Math.SQRT1_2];
    const ray = {
      origin: angle.map((value, at) => value + 90 * out[at]!) as unknown as Point,
      direction: out.map((value) => -value) as unknown as Point,
    };
    expect(led(LINEAR, 'angle', ray).angle).toBeCloseTo(20, 0);
  });

  it('keep a muscle one that the service takes', () => {
    expect(placed(LINEAR, 'insertion', [0, -100, 60]).radius).toBeGreaterThan(100);
    expect(led(LINEAR, 'radius', through([60, -20, 60])).radius).toBeGreaterThan(50);
    expect(led(RING, 'semi_major', through([900, -70, 0])).semi_major).toBe(80);
  });

  it('move one end of a sheet and leave the other', () => {
    expect(placed(SHEET, 'attachment.1', [22, 61, 88])).toEqual({
      attachment: [
        [0, 60, 90],
        [22, 61, 88],
      ],
    });
  });

  it('outline where a muscle acts', () => {
    const [fibre, sector] = zoneOf(LINEAR);
    expect(fibre).toEqual([LINEAR.attachment, LINEAR.insertion]);
    for (const point of sector!.slice(1, -1)) {
      const off = point.map((value, axis) => value - (LINEAR.attachment as Point)[axis]!);
      expect(Math.hypot(...off)).toBeCloseTo(70);
    }
  });

  it('are mirrored for the other side', () => {
    expect(mirroredChange({ attachment: [1, 2, 3], radius: 4 })).toEqual({
      attachment: [-1, 2, 3],
      radius: 4,
    });
    expect(
      mirroredChange({
        insertion: [
          [1, 2, 3],
          [4, 5, 6],
        ],
      }),
    ).toEqual({
      insertion: [
        [-1, 2, 3],
        [-4, 5, 6],
      ],
    });
  });
});

describe('handles on a face that moves', () => {
  // Two points of skin: the one at the insertion goes up, the one at the other end of the face stays.
  const ground = {
    rest: new Float32Array([30, -60, 60, 0, 90, 90]),
    displacement: (point: number): Point => (point === 0 ? [0.002, 0.01, 0] : [0, 0, 0]),
    jaw: () => SHUT,
  };
  const carrier = carrierOf(ground);
  const drawnOf = (muscle: MuscleForm, id: string): Point =>
    carriedHandles(muscle, carrier).find((handle) => handle.id === id)!.drawn;

  it('know how far the skin over them has gone', () => {
    expect(nearestPoint(ground, [1, 80, 70])).toBe(1);
    expect(carrier.skin([29, -50, 60])).toEqual([2, 10, 0]);
  });

  it('stand where its fibres end, and on the bone where those begin', () => {
    const fibres = fibresOf(LINEAR).map((fibre) => carriedFibre(fibre, carrier));
    const middle = fibres[(fibres.length - 1) / 2]!;
    expect(drawnOf(LINEAR, 'insertion')).toEqual([32, -50, 60]);
    middle.at(-1)!.forEach((value, axis) => {
      expect(value).toBeCloseTo(drawnOf(LINEAR, 'insertion')[axis]!);
    });
    expect(drawnOf(LINEAR, 'attachment')).toEqual(middle[0]);
    expect(carriedHandles(LINEAR, carrier).map(({ place }) => place)).toEqual(
      handlesOf(LINEAR).map(({ place }) => place),
    );
    expect(carriedZone(LINEAR, carrier)[0]).toEqual([LINEAR.attachment, [32, -50, 60]]);
  });

  it('go with the skin over a ring, and at either end of a sheet', () => {
    expect(drawnOf(RING, 'center')).toEqual([2, -60, 110]);
    expect(carriedZone(RING, carrier)[0]![0]).toEqual([42, -60, 100]);
    expect(drawnOf(SHEET, 'insertion.1')).toEqual([20, 20, 90]);
    const low: MuscleForm = {
      ...SHEET,
      insertion: [
        [0, 60, 90],
        [28, -58, 60],
      ],
    };
    expect(drawnOf(low, 'insertion.0')).toEqual([0, 60, 90]);
    expect(drawnOf(low, 'insertion.1')).toEqual([30, -48, 60]);
  });

  it('that are led to where they are drawn change nothing', () => {
    const led = (muscle: MuscleForm, id: string) =>
      ledAsCarried(muscle, id, through(drawnOf(muscle, id)), carrier);
    const { radius } = led(LINEAR, 'radius');
    expect(radius).toBeCloseTo(70);
    expect(led(RING, 'semi_minor')).toEqual({ semi_minor: 20 });
    expect(led(RING, 'semi_major')).toEqual({ semi_major: 40 });
  });

  it('keep a muscle that reaches beyond its insertion at rest', () => {
    // The face has brought its ends together: 42 mm, and 50 at rest.
    const { radius } = ledAsCarried(
      LINEAR,
      'radius',
      through(drawnOf(LINEAR, 'insertion')),
      carrier,
    );
    expect(radius).toBe(51);
  });
});

describe('a muscle of the mandible on a face with its jaw open', () => {
  const LOW: MuscleForm = {
    name: 'depressor_anguli_oris.L',
    kind: 'linear',
    attachment: [30, -100, 60],
    insertion: [30, -60, 60],
    radius: 60,
    angle: 20,
    jaw_share: 0.8,
  };
  const jaw = {
    hinge: [0, -30, 4],
    offset: [0, 0, 10],
    quaternion: [Math.sin(0.25), 0, 0, Math.cos(0.25)],
  } as const;
  const carrier = carrierOf({
    rest: new Float32Array([30, -60, 60, 0, 90, 90]),
    displacement: (point) => (point === 0 ? [0, -0.01, 0] : [0, 0, 0]),
    jaw: () => jaw,
  });
  const lowered = rideOf(jaw, 0.8).to(LOW.attachment as Point);
  const handleOf = (id: string) => carriedHandles(LOW, carrier).find((handle) => handle.id === id)!;

  it('has its bone end and its fibres where the jaw has carried them', () => {
    expect(lowered[1]).toBeLessThan(-115);
    expect(handleOf('attachment').drawn).toEqual(lowered);
    expect(handleOf('attachment').place).toEqual(LOW.attachment);
    expect(handleOf('insertion').drawn).toEqual([30, -70, 60]);
    expect(carriedZone(LOW, carrier)[0]).toEqual([lowered, [30, -70, 60]]);
    const fibres = fibresOf(LOW).map((fibre) => carriedFibre(fibre, carrier));
    const middle = fibres[2]!;
    middle[0]!.forEach((value, axis) => {
      expect(value).toBeCloseTo(lowered[axis]!);
    });
    middle.at(-1)!.forEach((value, axis) => {
      expect(value).toBeCloseTo([30, -70, 60][axis]!);
    });
  });

  it('is edited as it is at rest', () => {
    const place = (id: string, at: Point) => atRest(LOW, handleOf(id), at, carrier);
    place('attachment', lowered).forEach((value, axis) => {
      expect(value).toBeCloseTo((LOW.attachment as Point)[axis]!);
    });
    expect(place('insertion', [31, -72, 60])).toEqual([31, -62, 60]);
    const drawn = handleOf('radius').drawn;
    expect(ledAsCarried(LOW, 'radius', through(drawn), carrier).radius).toBeCloseTo(60, 0);
  });
});

describe('a muscle in hand', () => {
  const RIGHT: MuscleForm = { ...LINEAR, ...mirroredChange(LINEAR), name: 'zygomatic_major.R' };
  const inHand = () => {
    const viewer = new ViewerState();
    const sent: string[] = [];
    const changes: object[] = [];
    const editing = new MuscleEditing({
      viewer,
      scene: { invalidate: () => undefined },
      layers: { load: () => Promise.resolve() },
      patch: (muscle: string, change: object) => {
        changes.push(change);
        return Promise.resolve(sent.push(muscle));
      },
    } as unknown as MuscleEditingParts);
    editing.use([LINEAR, RIGHT, RING], true);
    editing.choose(LINEAR.name);
    return { viewer, editing, sent, changes };
  };

  it('is moved alone, or with its twin, and undone as it was moved', () => {
    const { viewer, editing, sent } = inHand();
    viewer.within.mirrored = false;
    editing.edit({ insertion: [25, -60, 60] }, 'insertion');
    viewer.within.mirrored = true;
    editing.edit({ insertion: [31, -62, 60] }, 'insertion');
    editing.edit({ insertion: [32, -63, 60] }, 'insertion');
    expect(viewer.within.forms[RIGHT.name]!.insertion).toEqual([-32, -63, 60]);
    expect(viewer.within.edits).toBe(2);
    editing.undo();
    expect(viewer.within.forms[RIGHT.name]).toEqual(RIGHT);
    expect(viewer.within.forms[LINEAR.name]!.insertion).toEqual([25, -60, 60]);
    editing.undo();
    expect(viewer.within.changed).toEqual([]);
    expect(viewer.within.edits).toBe(0);
    expect(sent).toContain(LINEAR.name);
  });

  it('rides the jaw at once by what its bone does there, which the service finds by itself', () => {
    const { viewer, editing, changes } = inHand();
    editing.edit({ attachment: [40, -90, 60], jaw_share: 0.9 }, 'attachment');
    expect(viewer.within.forms[LINEAR.name]!.jaw_share).toBe(0.9);
    expect(changes).toEqual([{ attachment: [40, -90, 60] }]);
    editing.use([{ ...LINEAR, jaw_share: 0.1 }, RIGHT, RING], true);
    editing.edit({ jaw_share: 0.9, radius: 80 }, 'radius');
    editing.undo();
    expect(viewer.within.forms[LINEAR.name]!.jaw_share).toBe(0.1);
  });

  it('may be one of the lids, which has numbers alone; air is none', () => {
    const { viewer, editing, changes } = inHand();
    const lid: MuscleForm = { name: 'levator_palpebrae.L', kind: 'lid', upper: -11.5, lower: 0 };
    const twin = { ...lid, name: 'levator_palpebrae.R' };
    editing.use([LINEAR, lid, twin, { name: 'lip_air', kind: 'air' }], true);
    expect(Object.keys(viewer.within.forms)).toEqual([LINEAR.name, lid.name, twin.name]);
    editing.choose(lid.name);
    viewer.within.mirrored = true;
    editing.edit({ upper: -15 }, 'upper');
    expect(changes).toEqual([{ upper: -15 }]);
    expect(viewer.within.forms[twin.name]!.upper).toBe(-15);
    expect(viewer.within.changed).toEqual([lid.name, twin.name]);
    editing.reset();
    expect(viewer.within.forms[twin.name]!.upper).toBe(-11.5);
  });

  it('is put back on both sides where both are moved, and that is undone', () => {
    const { viewer, editing } = inHand();
    viewer.within.mirrored = true;
    editing.edit({ radius: 90 }, 'radius');
    expect(viewer.within.changed).toEqual([LINEAR.name, RIGHT.name]);
    editing.reset();
    expect(viewer.within.changed).toEqual([]);
    editing.undo();
    expect(viewer.within.forms[RIGHT.name]!.radius).toBe(90);
  });

  it('has a twin by its side, a ring around the middle none', () => {
    expect(twinOf(LINEAR.name)).toBe(RIGHT.name);
    expect(twinOf(RIGHT.name)).toBe(LINEAR.name);
    expect(twinOf(RING.name)).toBe('');
  });
});

describe('Newest', () => {
  it('has one change under way, and sends what came meanwhile as one', async () => {
    const sent: [string, object][] = [];
    const failures: string[] = [];
    let answer: (() => void) | null = null;
    const newest = new Newest<{ radius?: number; angle?: number }>(
      (key, change) => {
        sent.push([key, change]);
        return new Promise((resolve, reject) => {
          answer =
            change.angle === 0
              ? () => {
                  reject(new Error('no'));
                }
              : () => {
                  resolve(null);
                };
        });
      },
      (key) => failures.push(key),
    );
    const answered = async (): Promise<void> => {
      answer!();
      await new Promise((resolve) => setTimeout(resolve));
    };
    newest.put('a', { radius: 1 });
    newest.put('a', { radius: 2 });
    newest.put('a', { radius: 3, angle: 0 });
    expect(sent).toEqual([['a', { radius: 1 }]]);
    await answered();
    expect(sent.at(-1)).toEqual(['a', { radius: 3, angle: 0 }]);
    newest.put('b', { radius: 5 });
    await answered();
    expect(failures).toEqual(['a']);
    expect(sent.at(-1)).toEqual(['b', { radius: 5 }]);
    expect(newest.idle).toBe(false);
    await answered();
    expect(newest.idle).toBe(true);
    expect(sent).toHaveLength(3);
  });
});
