// Two faces side by side: each half of the picture shows one of them.

import type { WebGLRenderer } from 'three';
import { Camera, Object3D, Scene } from 'three';
import { expect, it } from 'vitest';
import { drawPair } from '../src/pair';

it('draws each in its half, and leaves both to be seen', () => {
  const [left, right] = [new Object3D(), new Object3D()];
  const drawn: unknown[] = [];
  let at = -1;
  const renderer = {
    domElement: { clientWidth: 800, clientHeight: 500 },
    setScissorTest: () => undefined,
    setViewport: (x: number) => (at = x),
    setScissor: () => undefined,
    render: () => drawn.push([at, left.visible, right.visible]),
  } as unknown as WebGLRenderer;
  drawPair(renderer, new Scene(), new Camera(), { left, right });
  expect(drawn).toEqual([
    [0, true, false],
    [400, false, true],
  ]);
  expect([left.visible, right.visible]).toEqual([true, true]);
});
