// A tracker's table as curves, its report in sentences, and jobs that are waited for or cancelled.

import { describe, expect, it, vi } from 'vitest';
import type { ClipInfo } from '../src/clip-jobs';
import { Cancelled, ClipJobs } from '../src/clip-jobs';
import { kindOf, sentencesOf, takeOfTable } from '../src/tracked';
import { valueAt } from '../src/take';

const TABLE = [
  'frame,time,AU12,L4,AU1,zygomatic_major.L,jaw_pitch,head_yaw,head_roll,gaze_left_yaw,x_0',
  '0,0,0.0000,0.0000,0.0000,0.1,0,0.000,0.1,0.000,1',
  '1,0.5,0.5000,0.0000,0.0100,0.1,5,5.000,0.2,-3.000,1',
  '2,1,1.0000,0.3000,0.0000,0.1,9,10.000,0.1,-6.000,1',
  '',
].join('\n');

describe('takeOfTable', () => {
  it('has a curve for what moves, and none for what does not or follows from it', () => {
    const take = takeOfTable(TABLE);
    expect(take.duration).toBe(1);
    expect(take.tracks.map(({ group, name }) => `${group}.${name}`)).toEqual([
      'action_units.AU12',
      'action_units.L4',
      'head.yaw',
      'gaze.yaw',
    ]);
    expect(take.tracks[0]!.keys).toEqual([
      { time: 0, value: 0 },
      { time: 1, value: 1 },
    ]);
    expect(valueAt(take.tracks[1]!.keys, 0.75)).toBeCloseTo(0.15);
  });

  it('says that nothing moves', () => {
    expect(() => takeOfTable('frame,time,AU12\n0,0,0.0\n1,1,0.01\n')).toThrow(/Nothing moves/);
  });
});

describe('a file', () => {
  it.each([
    ['Laugh.CSV', 'text/csv'],
    ['face.jsonl', 'application/jsonl'],
    ['take.json', null],
    ['noending', null],
  ])('is told apart by its name: %s', (name, kind) => {
    expect(kindOf(name)).toBe(kind);
  });

  it('is told in sentences, what was read first', () => {
    const report = { tracker: 'OpenFace 2', rows: 90, used: 80, duration: 2.96, rate: 30 };
    expect(sentencesOf('a.csv', { ...report, left_out: 3, notes: ['AU45 is stuck.'] })).toEqual([
      'a.csv, OpenFace 2: 80 of 90 rows count, 3.0 s at 30 a second.',
      '3.0 s at its end are left out.',
      'AU45 is stuck.',
    ]);
  });
});

function service(answers: ClipInfo[]): { asked: string[]; jobs: ClipJobs } {
  const asked: string[] = [];
  const jobs = new ClipJobs((method, path) => {
    asked.push(`${method} ${path}`);
    const text = path.endsWith('.csv') ? TABLE : JSON.stringify(answers.shift() ?? null);
    return Promise.resolve(new Response(text));
  });
  return { asked, jobs };
}

describe('ClipJobs', () => {
  it('waits for a file that is read, takes its table, and leaves nothing behind', async () => {
    const track = { tracker: 'x', rows: 1, used: 1, duration: 1, rate: 30, notes: [] };
    const { asked, jobs } = service([
      { id: 'a', status: 'queued' },
      { id: 'a', status: 'running', progress: 0.5 },
      { id: 'a', status: 'done', report: { track } },
    ]);
    const onProgress = vi.fn();
    const cancelled = new AbortController().signal;
    const read = await jobs.read(new Blob(['x']), 'amara', { onProgress, cancelled });
    expect(read).toEqual({ table: TABLE, report: track });
    expect(onProgress.mock.calls).toEqual([[0], [0.5]]);
    expect(asked).toEqual([
      'POST api/clips?fps=30&level=low&textures=false&rig=amara',
      'GET api/clips/a?wait=1',
      'GET api/clips/a?wait=1',
      'GET api/clips/a.csv',
      'DELETE api/clips/a',
    ]);
  });

  it('has what was cancelled end, and says what failed', async () => {
    const stop = new AbortController();
    const { asked, jobs } = service([{ id: 'a', status: 'running' }]);
    stop.abort();
    const waiting = { onProgress: vi.fn(), cancelled: stop.signal };
    await expect(jobs.render({}, waiting)).rejects.toThrow(Cancelled);
    expect(asked).toEqual(['POST api/clips', 'DELETE api/clips/a']);
    const failing = service([{ id: 'a', status: 'failed', message: 'it diverged' }]);
    await expect(failing.jobs.render({}, waiting)).rejects.toThrow('it diverged');
  });
});
