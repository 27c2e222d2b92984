// What the page lists beside the face: people to meet, and where expressions lie among feelings.

import type { Api } from '../api';
import { ApiError } from '../refusal';
import { readable } from '../state/rig';
import type { ViewerState } from '../state/viewer.svelte';

/** List the people, once the service may be asked. */
export async function loadPeople(api: Api, viewer: ViewerState): Promise<void> {
  try {
    const { people, attributes } = await api.people();
    viewer.attributes = attributes ?? {};
    viewer.people = people.map(({ name, title }) => ({ name, title, label: readable(name) }));
  } catch (error) {
    if (!(error instanceof ApiError && error.status === 401)) viewer.sayWhy(error);
  }
}

/** Learn where expressions lie among feelings; without that the plane has no signposts. */
export async function loadFeelings(api: Api, viewer: ViewerState): Promise<void> {
  const { recipes } = await api.feelings().catch(() => ({ recipes: [] }));
  viewer.places = recipes.flatMap(({ name, valence, arousal, dominance = 0, anchor = false }) =>
    valence === undefined || arousal === undefined
      ? []
      : [{ name, valence, arousal, dominance, anchor }],
  );
}
