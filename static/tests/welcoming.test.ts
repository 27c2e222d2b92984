// A face or a rig that the service did not give is asked for again, once at a time.

import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import type { Api } from '../src/api';
import type { OnStage } from '../src/app/on-stage';
import type { Opening } from '../src/app/opening';
import type { Told } from '../src/app/told';
import { Welcoming } from '../src/app/welcoming';
import type { Hello } from '../src/protocol';
import { ApiError } from '../src/refusal';
import { ViewerState } from '../src/state/viewer.svelte';

const HELLO = { type: 'hello', session: 's', rig: 'r', surface: '/r.glb' } as Hello;

describe('Welcoming', () => {
  let shown = 0;
  let described: string[] = [];
  let working = false;
  let failure: Error;
  let given: unknown[] = [];
  let opening: Pick<Opening, 'session' | 'isGuest' | 'countViewers'>;
  /** What a face on its way waits for. */
  let slow: Promise<void> | null = null;
  const make = (): Welcoming => {
    opening = { session: '', isGuest: false, countViewers: () => Promise.resolve() };
    const stage = {
      address: '',
      loading: false,
      show: (address: string) => {
        shown++;
        if (!working) return Promise.reject(failure);
        stage.loading = true;
        stage.address = address;
        return (slow ?? Promise.resolve()).then(() => {
          stage.loading = false;
        });
      },
      finish: () => Promise.resolve(),
    };
    const told = {
      rigId: '',
      take: () => undefined,
      showRig: (id: string) => {
        described.push(id);
        told.rigId = id;
        return Promise.resolve();
      },
    };
    const api = { key: '', ticket: '', place: (where: string) => `http://there${where}` };
    return new Welcoming(
      api as unknown as Api,
      new ViewerState(),
      opening as unknown as Opening,
      stage as unknown as OnStage,
      told as unknown as Told,
      'high',
      (error) => given.push(error),
    );
  };

  beforeEach(() => {
    [shown, described, working, given, slow] = [0, [], false, [], null];
    failure = new Error('The service is busy.');
    vi.useFakeTimers();
    vi.stubGlobal('document', { body: { classList: { toggle: () => undefined } } });
  });

  afterEach(() => {
    vi.useRealTimers();
    vi.unstubAllGlobals();
  });

  it('asks again by longer and longer pauses, and then no more', async () => {
    const welcoming = make();
    await welcoming.take(HELLO);
    const asked: number[] = [];
    for (let second = 0; second < 32; second++) {
      await vi.advanceTimersByTimeAsync(1000);
      asked.push(shown);
    }
    expect([asked[0], asked[2], asked[6], asked[14]]).toEqual([2, 3, 4, 5]);
    expect(asked.at(-1)).toBe(5);
  });

  it('gives up at once what is refused for good', async () => {
    failure = new ApiError(404, 'No rig is called r.');
    await make().take(HELLO);
    await vi.advanceTimersByTimeAsync(60_000);
    expect([shown, given]).toEqual([1, [failure]]);
  });

  it('leaves a busy service alone for as long as it asks', async () => {
    failure = new ApiError(503, 'Busy.', 9);
    await make().take(HELLO);
    await vi.advanceTimersByTimeAsync(8999);
    expect(shown).toBe(1);
    await vi.advanceTimersByTimeAsync(1);
    expect(shown).toBe(2);
  });

  it('does not give up the next face for the one that it left', async () => {
    failure = new ApiError(404, 'No rig is called r.');
    const welcoming = make();
    const taken = welcoming.take(HELLO);
    opening.session = '';
    await taken;
    expect(given).toEqual([]);
  });

  it('leaves a face that the page has gone on from while it was on its way', async () => {
    const welcoming = make();
    working = true;
    let arrive = (): void => undefined;
    slow = new Promise((resolve) => (arrive = resolve));
    const before = welcoming.take(HELLO);
    slow = null;
    await welcoming.take({ ...HELLO, session: 't', rig: 'newer', surface: '/newer.glb' } as Hello);
    let resumed = 0;
    welcoming.resume = () => resumed++;
    arrive();
    await before;
    expect([described, resumed]).toEqual([['newer'], 0]);
  });

  it('describes the rig that an edit moved the session to while its face was on its way', async () => {
    const welcoming = make();
    working = true;
    let arrive = (): void => undefined;
    slow = new Promise((resolve) => (arrive = resolve));
    const taken = welcoming.take(HELLO);
    slow = null;
    await welcoming.take({ ...HELLO, type: 'rig', rig: 'edited' } as Hello);
    arrive();
    await taken;
    expect(described).toEqual(['edited']);
  });

  it('asks once at a time where the line broke while it waited', async () => {
    const welcoming = make();
    await welcoming.take(HELLO);
    await vi.advanceTimersByTimeAsync(500);
    await welcoming.take(HELLO);
    expect(shown).toBe(2);
    await vi.advanceTimersByTimeAsync(900);
    expect(shown).toBe(2);
    await vi.advanceTimersByTimeAsync(200);
    expect(shown).toBe(3);
  });

  it('keeps the rig that an edit moved the session to while it waited', async () => {
    const welcoming = make();
    await welcoming.take(HELLO);
    await welcoming.take({ ...HELLO, type: 'rig', rig: 'edited' } as unknown as Hello);
    working = true;
    await vi.advanceTimersByTimeAsync(1000);
    expect([shown, described]).toEqual([2, ['edited']]);
  });
});
