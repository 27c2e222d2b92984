// Live edits of tissue and muscles: the session moves to a rig that differs by them.

import type { Api } from '../api';
import { Edits } from '../edits';
import type { Actions } from '../state/actions';
import { tissuePatch } from '../state/rig';
import type { ViewerState } from '../state/viewer.svelte';
import type { Opening } from './opening';

type TissueActions = Pick<Actions, 'setTissue' | 'setMuscleField'>;

export function tissueActions(api: Api, viewer: ViewerState, opening: Opening): TissueActions {
  const edits = new Edits((key, reason) => {
    Reflect.deleteProperty(viewer.edits, key);
    viewer.say(reason);
  });
  return {
    setTissue(path, value) {
      const key = path.join('.');
      viewer.edits[key] = value;
      edits.edit(key, () => api.patchTissue(opening.session, tissuePatch(path, value)));
    },
    setMuscleField(muscle, field, value) {
      const key = `${muscle}.${field}`;
      viewer.edits[key] = value;
      edits.edit(key, () => api.patchMuscle(opening.session, muscle, { [field]: value }));
    },
  };
}
