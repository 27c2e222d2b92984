// Somebody else on the stage: a person by name, one made to order, a stranger, the same face at another age.

import type { Api } from '../api';
import type { Commands } from '../commands';
import type { Connection } from '../connection';
import type { Recipe } from '../recipe';
import type { Actions } from '../state/actions';
import type { ViewerState } from '../state/viewer.svelte';
import { debounce } from '../throttle';
import type { Opening } from './opening';
import type { Told } from './told';
import type { Welcoming } from './welcoming';

const PERSON_PAUSE_MS = 350;
/** How many strangers there are to meet; any seed below 2^32 is one. */
const STRANGERS = 2 ** 32;

export interface PersonParts {
  api: Api;
  viewer: ViewerState;
  commands: Commands;
  connection: Connection;
  opening: Opening;
  told: Told;
  welcoming: Welcoming;
}

type PersonActions = Pick<Actions, 'switchRig' | 'setPerson' | 'meetStranger' | 'setTissueAge'>;

export function personActions(parts: PersonParts): PersonActions {
  const { api, viewer, commands, connection, opening, told, welcoming } = parts;
  /** What was asked of the person on the stage since they were made; the rest follows sex and age. */
  let wished: Recipe = {};
  let wishes = 0;

  const sayWhy = (error: unknown): void => {
    viewer.sayWhy(error);
  };

  const switchRig = (rig: string): void => {
    if (rig === viewer.rigName && viewer.status === 'open') return;
    if (opening.isGuest) {
      viewer.say('This link is for one face. Open the page with a key to see others.');
      return;
    }
    const left = opening.session;
    opening.session = '';
    viewer.rigName = rig;
    welcoming.resume = commands.carried();
    commands.forget();
    connection.connect();
    opening.leave(left);
  };

  /** Make the person that the panel asks for, once its sliders rest; the newest wish counts. */
  const becomePerson = debounce(() => {
    const asked = ++wishes;
    api
      .person(told.rigId, { ...wished })
      .then(({ id }) => {
        if (asked !== wishes) return;
        wished = {};
        switchRig(id);
      })
      .catch(sayWhy);
  }, PERSON_PAUSE_MS);

  return {
    switchRig,
    setPerson(attribute, value) {
      if (viewer.recipe === null) return;
      viewer.recipe[attribute] = value;
      wished[attribute] = value;
      becomePerson();
    },
    meetStranger() {
      viewer.meeting = true;
      api
        .stranger(Math.floor(Math.random() * STRANGERS))
        .then(({ id }) => {
          switchRig(id);
        })
        .catch(sayWhy)
        .finally(() => (viewer.meeting = false));
    },
    setTissueAge(age) {
      api
        .aged(told.rigId, age)
        .then(({ id }) => {
          switchRig(id);
        })
        .catch(sayWhy);
    },
  };
}
