// Wires the parts together: page address, service, stage, panels. Only this file knows all of them.

import { mount } from 'svelte';
import type { SessionInfo } from './api';
import { Api, ApiError } from './api';
import { Connection } from './connection';
import type { Triple } from './face';
import { Face } from './face';
import Panels from './panels/Panels.svelte';
import StatusBar from './panels/StatusBar.svelte';
import type { FaceState, Hello, Layer } from './protocol';
import { controlsCommand, emotionCommand, LAYERS, replaceCommand } from './protocol';
import { Scene } from './scene';
import type { Actions, Group } from './state/actions';
import { describeRig, tissuePatch } from './state/rig';
import { ViewerState } from './state/viewer.svelte';
import './style.css';
import { TickRate } from './tick-rate';
import { debounce, Throttle } from './throttle';
import { readPageOptions } from './url';

const EMOTION_FADE_SECONDS = 0.25;
const RELEASE_FADE_SECONDS = 0.2;
const EDIT_PAUSE_MS = 180;
/** After a slider was moved here, what the service reports of it is older than the hand for this long. */
const HANDS_OFF_MS = 700;

/** What browser tests, contact sheets and curious visitors may read and do. */
export interface ViewerHandle {
  readonly ready: boolean;
  readonly connected: boolean;
  readonly session: string;
  readonly rig: string;
  readonly tick: number;
  readonly framesDrawn: number;
  readonly asleep: boolean;
  readonly landmarks: Readonly<Record<string, number>>;
  point(which: string | number): Triple;
  drawnVertex(index: number): Triple;
  setView(name: string): void;
  render(): Promise<void>;
}

declare global {
  interface Window {
    __viewer: ViewerHandle;
  }
}

const page = readPageOptions(window.location.search);
const api = new Api(document.baseURI);
const viewer = new ViewerState();
const { sliders } = viewer;
const rate = new TickRate();
viewer.rigName = page.rig;
viewer.view = page.view;
document.body.classList.toggle('bare', page.bare);

let face: Face | null = null;
let surfaceAddress = '';
let rigId = '';
let tick = 0;
let touchedAt = -Infinity;
/** The session to attach to; empty to open one. */
let session = page.session ?? '';

const element = (id: string): HTMLElement => document.getElementById(id)!;
const scene = new Scene(element('face') as HTMLCanvasElement, {
  orbit: !page.bare,
  pixelRatio: page.pixelRatio,
  view: page.view,
  update: applyNewestFrame,
});
const connection = new Connection({
  locate: locateStream,
  onHello: (hello) => void welcome(hello),
  onState: (message) => {
    takeState(message.state ?? message);
  },
  onTrouble: (trouble) => (viewer.notice = trouble.message),
  onStatus: (status, detail) => {
    viewer.status = status;
    viewer.detail = detail;
  },
  onFrameReady: () => {
    scene.wake();
  },
});
const throttle = new Throttle((groups) => {
  connection.send(controlsCommand(groups));
});

/** Find the session, or open one if there is none any more, and give the address of its stream. */
async function locateStream(): Promise<string> {
  if (session !== '') {
    const known = await api.session(session).catch((error: unknown) => {
      if (error instanceof ApiError && error.status === 404) return null;
      throw error;
    });
    if (known !== null) return streamOf(known);
  }
  const opened = await api.openSession(viewer.rigName);
  session = opened.id;
  const address = new URL(window.location.href);
  address.searchParams.set('session', session);
  address.searchParams.set('rig', viewer.rigName);
  window.history.replaceState(null, '', address);
  return streamOf(opened);
}

function streamOf(info: SessionInfo): string {
  return info.stream === undefined
    ? api.streamAddress(info.id)
    : api.address(info.stream).replace(/^http/, 'ws');
}

/** A hello, first or later: the face on the stage may be of another rig. */
async function welcome(hello: Hello): Promise<void> {
  viewer.session = session = hello.session;
  if (hello.state !== undefined) takeState(hello.state);
  const address = api.address(hello.surface);
  try {
    if (hello.type === 'hello' && address !== surfaceAddress) await showFace(address);
    if (hello.rig !== rigId) await showRig(hello.rig, hello.type === 'hello');
  } catch (error) {
    viewer.notice = error instanceof Error ? error.message : 'The face cannot be loaded.';
  }
}

async function showFace(address: string): Promise<void> {
  const loaded = await Face.load(address);
  face?.dispose();
  face = loaded;
  surfaceAddress = address;
  scene.add(face.root);
  viewer.surfaceReady = true;
  // The frame that came while loading is still waiting.
  await scene.rendered();
  element('curtain').classList.add('open');
}

async function showRig(id: string, isNew: boolean): Promise<void> {
  rigId = id;
  const described = await api.rig(id);
  if (rigId !== id) return;
  const rig = describeRig(described);
  if (isNew) {
    viewer.rig = rig;
    viewer.edits = {};
    if (rig.name === 'standard' || rig.name === 'paper') viewer.rigName = rig.name;
  } else if (viewer.rig !== null) {
    // An edit derived this rig. Its own numbers stay what the sliders count from.
    viewer.rig = { ...viewer.rig, id };
  }
}

function takeState(state: FaceState): void {
  viewer.merged = state.merged ?? {};
  if (performance.now() - touchedAt < HANDS_OFF_MS) return;
  sliders.take(state.layers?.puppet ?? {});
  const emotion = state.layers?.emotion?.emotion;
  viewer.emotion = emotion?.label ?? '';
  if (emotion !== undefined) viewer.emotionIntensity = emotion.intensity;
}

/** Tells whether the face changed. */
function applyNewestFrame(): boolean {
  if (face === null) return false;
  const frame = connection.takeFrame();
  if (frame === null) return false;
  let changed: boolean;
  try {
    changed = face.apply(frame);
  } catch (error) {
    viewer.notice = error instanceof Error ? error.message : 'A frame cannot be drawn.';
    return false;
  }
  tick = frame.tick;
  viewer.asleep = frame.asleep;
  viewer.tickRate = rate.at(frame.tick, performance.now());
  return changed;
}

/** Hold a unit either as a whole or by its sides, never both: AU12 beside L12 would say two things of the left. */
function settleSides(name: string): void {
  const values = sliders.action_units;
  const number = name.replace(/^(AU|L|R)/, '');
  const [whole, left, right] = [`AU${number}`, `L${number}`, `R${number}`];
  if (name === whole) {
    for (const side of [left, right]) if (side in values) drop('action_units', side);
  } else if (whole in values) {
    const held = values[whole]!;
    drop('action_units', whole);
    for (const side of [left, right]) hold('action_units', side, held);
  }
}

function hold(group: Group, name: string, value: number): void {
  sliders[group][name] = value;
  throttle.set(group, name, value);
}

/** Zero lets go of units and muscles. */
function drop(group: Group, name: string): void {
  Reflect.deleteProperty(sliders[group], name);
  throttle.set(group, name, 0);
}

function release(layer: Layer): void {
  connection.send(replaceCommand({ layer, fade: RELEASE_FADE_SECONDS }));
}

/** One debounced edit per thing edited, so that two sliders moved in turn both arrive. */
const pendingEdits = new Map<string, () => void>();
const flushEdits = debounce(() => {
  const edits = [...pendingEdits.values()];
  pendingEdits.clear();
  for (const edit of edits) edit();
}, EDIT_PAUSE_MS);

function edit(key: string, value: number, send: () => Promise<unknown>): void {
  viewer.edits[key] = value;
  pendingEdits.set(key, () => {
    send().catch((error: unknown) => {
      viewer.notice = error instanceof Error ? error.message : 'The edit failed.';
    });
  });
  flushEdits();
}

const actions: Actions = {
  set(group, name, value) {
    touchedAt = performance.now();
    if (group === 'action_units') settleSides(name);
    hold(group, name, value);
  },
  letGo(group, name) {
    touchedAt = performance.now();
    if (group === 'action_units') settleSides(name);
    Reflect.deleteProperty(sliders[group], name);
    throttle.clear();
    connection.send(
      replaceCommand({ layer: 'puppet', fade: RELEASE_FADE_SECONDS, ...sliders.all() }),
    );
  },
  playEmotion(label, intensity) {
    const fade = label === viewer.emotion ? 0 : EMOTION_FADE_SECONDS;
    touchedAt = performance.now();
    viewer.emotion = label;
    connection.send(emotionCommand(label, intensity, fade));
  },
  stopEmotion() {
    touchedAt = performance.now();
    viewer.emotion = '';
    release('emotion');
  },
  setTissue(path, value) {
    edit(path.join('.'), value, () => api.patchTissue(session, tissuePatch(path, value)));
  },
  setMuscleField(muscle, field, value) {
    edit(`${muscle}.${field}`, value, () => api.patchMuscle(session, muscle, { [field]: value }));
  },
  switchRig(rig) {
    if (rig === viewer.rigName && viewer.status === 'open') return;
    const left = session;
    session = '';
    viewer.rigName = rig;
    viewer.emotion = '';
    sliders.take({});
    connection.connect();
    if (left !== '') api.closeSession(left).catch(() => undefined);
  },
  setView(view) {
    viewer.view = view;
    scene.setView(view);
  },
  reset() {
    touchedAt = performance.now();
    throttle.clear();
    sliders.take({});
    viewer.emotion = '';
    viewer.notice = '';
    for (const layer of LAYERS) release(layer);
    scene.setView(viewer.view);
  },
  reconnect() {
    connection.connect();
  },
};

window.__viewer = {
  get ready() {
    return viewer.surfaceReady && viewer.rig !== null && tick > 0;
  },
  get connected() {
    return viewer.status === 'open';
  },
  get session() {
    return viewer.session;
  },
  get rig() {
    return rigId;
  },
  get tick() {
    return tick;
  },
  get framesDrawn() {
    return scene.framesDrawn;
  },
  get asleep() {
    return viewer.asleep;
  },
  get landmarks() {
    return face?.landmarks ?? {};
  },
  point: (which) => shownFace().point(which),
  drawnVertex: (index) => shownFace().drawnVertex(index),
  setView: (name) => {
    scene.setView(name);
  },
  render: () => scene.rendered(),
};

function shownFace(): Face {
  if (face === null) throw new Error('The face is not loaded yet; wait for __viewer.ready.');
  return face;
}

if (!page.bare) {
  mount(StatusBar, { target: element('bar'), props: { viewer, actions } });
  mount(Panels, {
    target: element('panels'),
    props: { viewer, actions, link: (path: string) => api.address(path) },
  });
}
connection.connect();
