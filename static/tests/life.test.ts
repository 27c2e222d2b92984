// The idle life of a face: asked for by the page, switched by the visitor, told by the service.

import { beforeEach, describe, expect, it, vi } from 'vitest';
import { Api } from '../src/api';
import { Commands } from '../src/commands';
import { ViewerState } from '../src/state/viewer.svelte';

describe('a session that the page opens', () => {
  const asked = vi.fn<typeof fetch>();
  beforeEach(() => {
    asked.mockReset();
    asked.mockResolvedValue(new Response('{"id": "a", "rig": "r"}', { status: 201 }));
    vi.stubGlobal('fetch', asked);
  });

  it.each([true, false])('says whether it lives: %s', async (idle) => {
    await new Api('http://localhost/').openSession('standard', idle);
    const body = asked.mock.calls[0]?.[1]?.body as string;
    expect(JSON.parse(body)).toEqual({ rig: 'standard', idle });
    vi.unstubAllGlobals();
  });
});

describe('the switch', () => {
  it('says so at once, and is not moved back by an older report', () => {
    const viewer = new ViewerState();
    const sent: unknown[] = [];
    const commands = new Commands(viewer, (text) => sent.push(JSON.parse(text)));
    commands.setAlive(true);
    expect(viewer.alive).toBe(true);
    commands.setAlive(false);
    expect(viewer.alive).toBe(false);
    expect(sent).toEqual([
      { type: 'idle', on: true },
      { type: 'idle', on: false },
    ]);
    expect(commands.mayFollow({})).toBe(false);
  });
});
