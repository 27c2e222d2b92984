// What a visitor reads while the face is not there yet.

import { describe, expect, it } from 'vitest';
import { fetching, painting, starting } from '../src/state/loading';
import { FaceMaps } from '../src/textures';

describe('fetching', () => {
  it('says whom, and how far, as far as that is known', () => {
    expect(fetching('Amara', 0, 0)).toEqual({ words: 'Fetching Amara', share: null });
    expect(fetching('Amara', 1.2e6, 0).words).toBe('Fetching Amara, 1.2 MB');
    expect(fetching('the face', 1e6, 4e6)).toEqual({
      words: 'Fetching the face, 1.0 of 4.0 MB',
      share: 0.25,
    });
  });

  it('gives up its share when a compressed file grows beyond its length', () => {
    expect(fetching('Amara', 5e6, 4e6).share).toBeNull();
  });
});

describe('painting', () => {
  it('counts the maps, as they come or fail', async () => {
    const told: [number, number][] = [];
    const none = { albedo: 'http://127.0.0.1:9/a.jpg', normal: 'http://127.0.0.1:9/b.jpg' };
    await new FaceMaps().load(none, (done, maps) => told.push([done, maps]));
    expect(told).toEqual([
      [0, 2],
      [1, 2],
      [2, 2],
    ]);
    expect(painting(1, 4)).toEqual({ words: 'Painting the skin, 1 of 4', share: 0.25 });
  });
});

describe('starting', () => {
  it('repeats what the service is at', () => {
    expect(starting('the service is compiling the simulation').words).toBe(
      'The service is starting: compiling the simulation',
    );
  });
});
