// Where maps are, and how they come in.

import { describe, expect, it } from 'vitest';
import { FaceMaps, fadeShare, mapAddresses } from '../src/textures';

describe('mapAddresses', () => {
  it('counts from the surface file, and takes only maps it knows', () => {
    const extras = { textures: { albedo: 'textures/albedo.jpg', moss: 'moss.jpg', orm: 3 } };
    expect(mapAddresses(extras, 'http://host/api/rigs/x/surface.glb?level=low')).toEqual({
      albedo: 'http://host/api/rigs/x/textures/albedo.jpg',
    });
    expect(mapAddresses(undefined, 'http://host/surface.glb')).toEqual({});
  });
});

describe('FaceMaps', () => {
  it('is settled at once when there are none', async () => {
    const maps = new FaceMaps();
    expect(maps.settled).toBe(false);
    expect(await maps.load({})).toBe('');
    expect([maps.settled, maps.fading, maps.shown.value]).toEqual([true, false, 0]);
  });

  it('keeps the vertex colours, and says so, when they cannot be had', async () => {
    const maps = new FaceMaps();
    const missing = await maps.load({ albedo: 'http://127.0.0.1:9/none.jpg' });
    expect(missing).toContain('albedo');
    expect([maps.settled, maps.shown.value]).toEqual([true, 0]);
  });
});

describe('fadeShare', () => {
  it('goes from 0 to 1 and stays there', () => {
    expect([-5, 0, 300, 600, 9999].map(fadeShare)).toEqual([0, 0, 0.5, 1, 1]);
  });
});
