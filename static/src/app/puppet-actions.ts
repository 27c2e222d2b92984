// What sliders, emotions and the FACS field do.

import type { Api } from '../api';
import { ApiError } from '../refusal';
import type { Commands } from '../commands';
import type { Actions } from '../state/actions';
import { unitsOf } from '../state/facs';
import type { ViewerState } from '../state/viewer.svelte';
import type { Told } from './told';

type PuppetActions = Pick<
  Actions,
  | 'set'
  | 'letGo'
  | 'playEmotion'
  | 'stopEmotion'
  | 'feel'
  | 'setFacs'
  | 'undo'
  | 'redo'
  | 'setAlive'
>;

export function puppetActions(
  api: Api,
  viewer: ViewerState,
  commands: Commands,
  told: Told,
): PuppetActions {
  return {
    set: (group, name, value) => {
      commands.set(group, name, value);
    },
    letGo: (group, name) => {
      commands.letGo(group, name);
    },
    playEmotion: (label, intensity) => {
      commands.playEmotion(label, intensity);
    },
    stopEmotion: () => {
      commands.stopEmotion();
    },
    feel: (valence, arousal) => {
      commands.feel(valence, arousal);
    },
    async setFacs(text) {
      try {
        const read =
          text === '' ? { units: [], warnings: [] } : await api.readFacs(text, told.rigId);
        commands.playUnits(unitsOf(read.units));
        viewer.say(read.warnings.map(({ message }) => message).join(' '));
        return '';
      } catch (error) {
        // Who came by a link may move the face, and read nothing but it: then the face is asked itself.
        if (error instanceof ApiError && error.status === 403) {
          commands.playText(text);
          return '';
        }
        return error instanceof Error ? error.message : 'That is no FACS string.';
      }
    },
    undo: () => {
      commands.undo();
    },
    redo: () => {
      commands.redo();
    },
    setAlive: (alive) => {
      commands.setAlive(alive);
    },
  };
}
