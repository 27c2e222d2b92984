// Wires the parts together: page address, service, stage, panels. Only this file knows all of them.

import { Api } from './api';
import { BesideOverlay } from './app/beside-overlay';
import { editByPointer } from './app/handle-pointer';
import { HeatOverlay } from './app/heat-overlay';
import { insideActions } from './app/inside-actions';
import { LayerOverlay } from './app/layer-overlay';
import { embed, tellAround, tellRefused } from './app/embedding';
import { loadFeelings, loadPeople } from './app/lists';
import { mountControls, mountCurtain } from './app/mounting';
import { MuscleEditing } from './app/muscle-editing';
import { MuscleOverlay } from './app/muscle-overlay';
import { moving, OnStage } from './app/on-stage';
import { Opening } from './app/opening';
import { personActions } from './app/person-actions';
import { provideHandle } from './app/provide-handle';
import { puppetActions } from './app/puppet-actions';
import { stageActions } from './app/stage-actions';
import { tissueActions } from './app/tissue-actions';
import { TrailOverlay } from './app/trail-overlay';
import { Told } from './app/told';
import { Welcoming } from './app/welcoming';
import { curtain } from './app/curtain';
import { Commands } from './commands';
import { Connection } from './connection';
import { decodeLayers } from './inside/layers-frame';
import { mark } from './marks';
import { offer } from './offer';
import { Performer } from './performer';
import type { Actions } from './state/actions';
import { TimelineState } from './state/timeline.svelte';
import { ViewerState } from './state/viewer.svelte';
import './style/all.css';
import { takeActions } from './take-actions';
import { keptTheme, onDeviceTheme, useTheme } from './theme';
import { ticketIn } from './ticket';
import { readPageOptions } from './url';

/** How often it is asked who else watches. */
const COUNT_MS = 5000;

mark('script');
const page = readPageOptions(window.location.search);
const api = new Api(document.baseURI);
api.ticket = ticketIn(window.location.href);
const viewer = new ViewerState();
viewer.rigName = page.rig;
viewer.view = page.view;
viewer.light = page.light;
viewer.embedded = page.embed;
// A page inside another one may be kept from its storage.
viewer.theme = page.embed ? 'auto' : keptTheme();
document.body.classList.toggle('bare', page.bare);
document.documentElement.classList.toggle('embed', page.embed);
if (page.bare && !page.embed) document.documentElement.dataset.theme = 'dark';

const opening = new Opening(page, api, viewer, curtain.close);
const connection: Connection = new Connection({
  locate: () => opening.locate(),
  onHello: (hello) => void welcoming.take(hello),
  onState: (message) => {
    told.take(message.state ?? message);
  },
  onTrouble: (trouble) => {
    viewer.say(trouble.message);
    // A warning is of what was obeyed, if only in part.
    if (page.embed && trouble.type === 'error') tellRefused(trouble);
  },
  onStatus: (status, detail, answer) => {
    viewer.status = status;
    viewer.detail = detail;
    viewer.answer = answer;
    // Before the first face the curtain says it.
    if (viewer.surfaceReady && viewer.isRefused && viewer.locked === '') viewer.say(detail);
  },
  onFrameReady: () => {
    scene.wake();
  },
});
// The service is asked first: it answers while the stage is built.
viewer.alive = page.idle && moving(page);
connection.connect();
const stage = new OnStage({
  page,
  viewer,
  canvas: document.getElementById('face') as HTMLCanvasElement,
  takeFrame: () => connection.takeFrame(),
  ticket: () => api.ticket,
  who: () => opening.who,
  onNothingDrawn: (words) => {
    opening.abandon();
    connection.close();
    if (page.embed) tellAround({ state: 'closed', session: '', words });
  },
});
const { scene } = stage;
mark('stage');
const muscles = new MuscleOverlay(viewer, scene);
stage.addOverlay(muscles);
const heat = new HeatOverlay(viewer, scene);
const trails = new TrailOverlay(viewer, scene, () => stage.tick);
const layers = new LayerOverlay(viewer, scene, {
  file: () => api.address(`api/rigs/${told.rigId}/tissue.glb`),
  ask: async () => decodeLayers(await api.layers(viewer.session)),
});
const editing = new MuscleEditing({
  viewer,
  scene,
  layers,
  patch: (muscle, change) => api.patchMuscle(viewer.session, muscle, change),
});
const beside = new BesideOverlay({
  api,
  viewer,
  scene,
  level: stage.chooseLevel(),
  address: () => stage.address,
  pose: () => stage.newest,
  repeat: () => {
    commands.carried()();
  },
});
const commands: Commands = new Commands(
  viewer,
  (text) => {
    connection.send(text);
    beside.tell(text);
  },
  undefined,
  () => {
    told.forget();
  },
);
const told: Told = new Told(api, viewer, commands, muscles, editing);
for (const overlay of [heat, trails, layers, editing, beside]) stage.addOverlay(overlay);
const welcoming = new Welcoming(api, viewer, opening, stage, told, stage.chooseLevel(), (error) => {
  connection.giveUp(error);
});
const timeline = new TimelineState();
const performer = new Performer(timeline, {
  held: () => commands.held(),
  pose: (pose, fade) => {
    commands.perform(pose, fade);
  },
  cue: (plays) => {
    commands.performCue(plays);
  },
});

const people = personActions({ api, viewer, commands, connection, opening, told, welcoming });
const actions: Actions = {
  ...puppetActions(api, viewer, commands, told),
  ...tissueActions(api, viewer, opening),
  ...people,
  ...stageActions(viewer, scene, muscles, opening),
  within: insideActions({
    api,
    viewer,
    commands,
    heat,
    layers,
    trails,
    beside,
    editing,
    rigId: () => told.rigId,
    setMuscles: (shown) => {
      viewer.inside = shown;
      muscles.refresh();
    },
    switchRig: people.switchRig,
  }),
  ...takeActions({
    timeline,
    performer,
    held: () => commands.held(),
    rig: () => ({ id: told.rigId, name: viewer.rig?.name ?? 'face' }),
    render: (clip, waiting) => api.clips.render(clip, waiting),
    read: (file, rig, waiting) => api.clips.read(file, rig, waiting),
    offer,
    failed: (error) => {
      viewer.sayWhy(error);
    },
    tell: (sentence) => {
      viewer.tell(sentence);
    },
  }),
  reset() {
    commands.reset();
    viewer.say('');
    scene.viewpoint.glideTo(viewer.view);
  },
  reconnect: () => {
    connection.connect();
  },
  unlock(key) {
    opening.useKey(key);
    viewer.locked = '';
    viewer.say('');
    connection.connect();
    if (!page.bare) loadLists();
  },
};

function loadLists(): void {
  void loadPeople(api, viewer);
  void loadFeelings(api, viewer);
}

provideHandle(viewer, stage, told, editing);
if (page.embed) embed(viewer, connection, commands, () => stage.frameSeen);
mountCurtain(viewer, actions);
if (!page.bare) {
  editByPointer(document.getElementById('face') as HTMLCanvasElement, viewer, editing);
  mountControls(api, viewer, timeline, actions);
  loadLists();
  window.setInterval(() => void opening.countViewers(), COUNT_MS);
  onDeviceTheme(() => {
    scene.setGround(useTheme(viewer.theme));
  });
}
