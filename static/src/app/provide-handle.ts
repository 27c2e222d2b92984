// Gives window.__viewer what tests, pictures and curious visitors may read and do.

import '../handle';
import type { ViewerState } from '../state/viewer.svelte';
import type { MuscleEditing } from './muscle-editing';
import type { OnStage } from './on-stage';
import type { Told } from './told';

export function provideHandle(
  viewer: ViewerState,
  stage: OnStage,
  told: Told,
  editing: MuscleEditing,
): void {
  const { scene } = stage;
  window.__viewer = {
    get ready() {
      return stage.complete && viewer.rig !== null && stage.frameSeen;
    },
    get connected() {
      return viewer.status === 'open';
    },
    get session() {
      return viewer.session;
    },
    get rig() {
      return told.rigId;
    },
    get tick() {
      return stage.tick;
    },
    get framesDrawn() {
      return scene.framesDrawn;
    },
    get asleep() {
      return viewer.asleep;
    },
    get textured() {
      return stage.face?.mapsSettled ?? false;
    },
    get landmarks() {
      return stage.face?.landmarks ?? {};
    },
    get handles() {
      return editing.places;
    },
    point: (which) => stage.shown.point(which),
    drawnVertex: (index) => stage.shown.drawnVertex(index),
    setView: (view) => {
      scene.viewpoint.setView(view);
    },
    setGround: (ground) => {
      scene.setGround(ground);
    },
    render: () => scene.rendered(),
  };
}
