// How the face is shown, and what of it is taken along: views, light, theme, a picture, a link.

import { copied, offer } from '../offer';
import type { Scene } from '../scene';
import type { Actions } from '../state/actions';
import type { ViewerState } from '../state/viewer.svelte';
import { useTheme } from '../theme';
import type { MuscleOverlay } from './muscle-overlay';
import type { Opening } from './opening';

type StageActions = Pick<
  Actions,
  | 'copy'
  | 'setView'
  | 'setLight'
  | 'setTheme'
  | 'setInside'
  | 'setTurning'
  | 'savePicture'
  | 'copyLink'
>;

export function stageActions(
  viewer: ViewerState,
  scene: Scene,
  muscles: MuscleOverlay,
  opening: Opening,
): StageActions {
  const sayWhy = (error: unknown): void => {
    viewer.sayWhy(error);
  };
  const copy = (text: string, what: string): void => {
    void copied(text).then((done) => {
      viewer.tell(
        done ? `${what} is on the clipboard.` : `The browser does not copy. ${what}: ${text}`,
      );
    });
  };
  return {
    copy,
    setView(view) {
      viewer.view = view;
      scene.viewpoint.glideTo(view);
    },
    setLight(light) {
      viewer.light = light;
      scene.setLight(light);
    },
    setTheme(theme) {
      viewer.theme = theme;
      scene.setGround(useTheme(theme));
    },
    setInside(inside) {
      viewer.inside = inside;
      muscles.refresh();
    },
    setTurning: (turning) => {
      scene.viewpoint.setTurning(turning);
    },
    savePicture() {
      scene
        .picture()
        .then((picture) => {
          offer(picture, `${viewer.rig?.name ?? 'face'}.png`);
        })
        .catch(sayWhy);
    },
    copyLink(role) {
      opening
        .link(role)
        .then((link) => {
          copy(link, role === 'read' ? 'A link to watch' : 'A link to move this face');
        })
        .catch(sayWhy);
    },
  };
}
