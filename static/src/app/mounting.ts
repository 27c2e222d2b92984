// Puts the panels into the page, and the page's keys and drops to work.

import { mount } from 'svelte';
import type { Api } from '../api';
import { takeDrops } from '../dropping';
import Curtain from '../panels/Curtain.svelte';
import Keys from '../panels/Keys.svelte';
import Panels from '../panels/Panels.svelte';
import People from '../panels/People.svelte';
import StageLegend from '../panels/StageLegend.svelte';
import StatusBar from '../panels/StatusBar.svelte';
import Timeline from '../panels/Timeline.svelte';
import { listenForShortcuts } from '../shortcuts';
import type { Actions } from '../state/actions';
import { shortcutsOf } from '../state/keys';
import type { TimelineState } from '../state/timeline.svelte';
import type { ViewerState } from '../state/viewer.svelte';
import { curtain } from './curtain';

const element = (id: string): HTMLElement => document.getElementById(id)!;

export function mountCurtain(viewer: ViewerState, actions: Actions): void {
  curtain.element().textContent = '';
  mount(Curtain, { target: curtain.element(), props: { viewer, actions } });
}

/** All that a visitor has beside the face itself. */
export function mountControls(
  api: Api,
  viewer: ViewerState,
  timeline: TimelineState,
  actions: Actions,
): void {
  const place = (path: string): string => api.place(path);
  const link = (path: string): string => api.address(path);
  element('face').addEventListener(
    'pointerdown',
    () => {
      element('drag').remove();
    },
    { once: true },
  );
  mount(StatusBar, { target: element('bar'), props: { viewer, actions, place } });
  mount(People, { target: element('people'), props: { viewer, actions, link } });
  mount(Timeline, { target: element('timeline'), props: { viewer, timeline, actions } });
  takeDrops(
    (file) => {
      actions.openTake(file);
    },
    (over) => document.body.classList.toggle('dropping', over),
  );
  const shortcuts = shortcutsOf(viewer, actions);
  listenForShortcuts(shortcuts);
  const legend = document.createElement('div');
  legend.id = 'legend';
  element('stage').append(legend);
  mount(StageLegend, { target: legend, props: { viewer } });
  mount(Keys, { target: document.body, props: { viewer, shortcuts } });
  mount(Panels, { target: element('panels'), props: { viewer, actions, link } });
}
