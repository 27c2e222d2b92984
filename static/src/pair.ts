// Two that are drawn side by side, each in its half of the picture, as seen from the same place.

import type { Camera, Object3D, Scene, WebGLRenderer } from 'three';

/** Null while one is on its way. */
export interface Pair {
  left: Object3D | null;
  right: Object3D | null;
}

/** Draw each in its half of the renderer's canvas, where the other is not seen. */
export function drawPair(
  renderer: WebGLRenderer,
  scene: Scene,
  camera: Camera,
  { left, right }: Pair,
): void {
  const { clientWidth: width, clientHeight: height } = renderer.domElement;
  renderer.setScissorTest(true);
  for (const [half, shown, hidden] of [
    [0, left, right],
    [1, right, left],
  ] as const) {
    if (shown !== null) shown.visible = true;
    if (hidden !== null) hidden.visible = false;
    renderer.setViewport((half * width) / 2, 0, width / 2, height);
    renderer.setScissor((half * width) / 2, 0, width / 2, height);
    renderer.render(scene, camera);
  }
  if (left !== null) left.visible = true;
  renderer.setScissorTest(false);
}
