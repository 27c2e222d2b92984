// Which session a page opens, and that one that shows nothing leaves none behind.

import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import type { Api } from '../src/api';
import { Opening } from '../src/app/opening';
import { ViewerState } from '../src/state/viewer.svelte';
import type { PageOptions } from '../src/url';

describe('Opening', () => {
  const closed: string[] = [];
  const api = {
    ticket: '',
    key: '',
    session: (id: string) => Promise.resolve({ id, viewers: 0 }),
    openSession: () => Promise.resolve({ id: 'new' }),
    closeSession: (id: string) => Promise.resolve(closed.push(id)),
    takeTicket: () => Promise.resolve(),
    starting: () => Promise.resolve(''),
    streamAddress: (id: string) => `ws://there/${id}`,
  } as unknown as Api;
  const opening = (): Opening =>
    new Opening({ embed: true } as PageOptions, api, new ViewerState(), () => undefined);

  beforeEach(() => {
    closed.length = 0;
    vi.stubGlobal('window', {
      location: { href: 'http://there/?embed=1' },
      history: { replaceState: () => undefined },
    });
  });

  afterEach(() => {
    vi.unstubAllGlobals();
  });

  it('opens a session where none is named, and keeps it', async () => {
    const opened = opening();
    await expect(opened.locate()).resolves.toBe('ws://there/new');
    expect([opened.session, closed]).toEqual(['new', []]);
  });

  it('closes what comes when nothing can be drawn any more', async () => {
    const opened = opening();
    const address = opened.locate();
    opened.abandon();
    await expect(address).rejects.toThrow('Nothing can be drawn here.');
    expect([opened.session, closed]).toEqual(['', ['new']]);
  });
});
