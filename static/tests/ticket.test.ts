// Where a page's key and ticket go, and where they do not.

import { afterEach, describe, expect, it, vi } from 'vitest';
import { Api } from '../src/api';
import { mapAddresses } from '../src/textures';
import { ticketIn, withTicket } from '../src/ticket';

const TICKET = `rst_${'0a'.repeat(32)}`;

describe('a ticket', () => {
  it('is read from the address of a page, if it is one', () => {
    expect(ticketIn(`http://host/?session=a&ticket=${TICKET}`)).toBe(TICKET);
    expect(ticketIn('http://host/?ticket=%22%3Cscript%3E')).toBe('');
    expect(ticketIn('http://host/')).toBe('');
  });

  it('goes with the surface to its maps', () => {
    const surface = withTicket('http://host/api/rigs/x/surface.glb?level=low', TICKET);
    expect(surface).toContain('level=low');
    expect(mapAddresses({ textures: { albedo: 'textures/albedo.jpg' } }, surface)).toEqual({
      albedo: `http://host/api/rigs/x/textures/albedo.jpg?ticket=${TICKET}`,
    });
  });
});

describe('Api', () => {
  afterEach(() => {
    vi.unstubAllGlobals();
  });

  it('puts its ticket into addresses of the API alone, and its key into headers', async () => {
    const asked: [string, RequestInit][] = [];
    vi.stubGlobal('fetch', (address: string, init: RequestInit) => {
      asked.push([address, init]);
      return Promise.resolve(new Response(`{"ticket": "${TICKET}"}`, { status: 201 }));
    });
    const api = new Api('http://host/face/');
    expect(api.address('api/people')).toBe('http://host/face/api/people');
    api.key = 'rsr_1_2';
    await api.takeTicket('a');
    expect(asked[0]![0]).toBe('http://host/face/api/sessions/a/tickets');
    expect(asked[0]![1].headers).toMatchObject({ Authorization: 'Bearer rsr_1_2' });
    expect(api.streamAddress('a')).toBe(`ws://host/face/api/sessions/a/stream?ticket=${TICKET}`);
    expect(api.place('/api/rigs/x/surface.glb')).toBe('http://host/face/api/rigs/x/surface.glb');
    expect(api.address('people/mei.jpg')).toBe('http://host/face/people/mei.jpg');
    expect(asked.map(([address]) => address).join()).not.toContain('rsr_');
  });
});
