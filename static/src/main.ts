// Wires the parts together: page address, service, stage, panels. Only this file knows all of them.

import { mount } from 'svelte';
import type { SessionInfo } from './api';
import { Api, ApiError } from './api';
import { Commands, HANDS_OFF_MS } from './commands';
import { Connection } from './connection';
import { takeDrops } from './dropping';
import { Edits } from './edits';
import { Face } from './face';
import './handle';
import type { Level } from './level';
import { atLevel, levelFor } from './level';
import Curtain from './panels/Curtain.svelte';
import Panels from './panels/Panels.svelte';
import Keys from './panels/Keys.svelte';
import People from './panels/People.svelte';
import StatusBar from './panels/StatusBar.svelte';
import Timeline from './panels/Timeline.svelte';
import type { FaceState, Hello } from './protocol';
import type { MuscleForm } from './muscle-shape';
import { MuscleView } from './muscle-view';
import { copied, offer } from './offer';
import { Performer } from './performer';
import { expressionOf } from './protocol';
import { Scene } from './scene';
import { listenForShortcuts } from './shortcuts';
import { shortcutsOf } from './state/keys';
import type { Actions } from './state/actions';
import { facsOf, unitsOf } from './state/facs';
import { middleOf } from './feelings';
import { fetching, painting, starting } from './state/loading';
import { describeRig, readable, tissuePatch } from './state/rig';
import { TimelineState } from './state/timeline.svelte';
import { ViewerState } from './state/viewer.svelte';
import './style.css';
import { takeActions } from './take-actions';
import { takeOf } from './take-of-clip';
import { debounce } from './throttle';
import { ticketIn, withTicket } from './ticket';
import { TickRate } from './tick-rate';
import type { Recipe } from './recipe';
import { keptTheme, onDeviceTheme, useTheme } from './theme';
import { readPageOptions } from './url';

const page = readPageOptions(window.location.search);
const api = new Api(document.baseURI);
api.ticket = ticketIn(window.location.href);
const viewer = new ViewerState();
const rate = new TickRate();
viewer.rigName = page.rig;
viewer.view = page.view;
viewer.alive = page.idle && moving();
viewer.light = page.light;
viewer.theme = keptTheme();
document.body.classList.toggle('bare', page.bare);
if (page.bare) document.documentElement.dataset.theme = 'dark';

const PERSON_PAUSE_MS = 350;
/** Where the key is kept: as long as the tab is open, and for this page only. */
const KEY_PLACE = 'risorius.key';
const START_POLL_MS = 500;
/** How often it is asked who else watches. */
const COUNT_MS = 5000;
api.key = window.sessionStorage.getItem(KEY_PLACE) ?? '';
/** What was asked of the person on the stage since they were made; the rest follows sex and age. */
let wished: Recipe = {};
let wishes = 0;
/** How many strangers there are to meet; any seed below 2^32 is one. */
const STRANGERS = 2 ** 32;

let face: Face | null = null;
/** Of the rig that is shown, and drawn over it while somebody looks inside. */
let muscles: readonly MuscleForm[] = [];
let muscleView: MuscleView | null = null;
/** Address of the surface that is wanted; the face shown may still be another. */
let surfaceAddress = '';
let surfaceLoading = false;
let rigId = '';
let tick = 0;
let frameSeen = false;
/** The session to attach to; empty to open one. */
let session = page.session ?? '';
/** Asks of a new face what the one before it did, so that two rigs can be compared. */
let resume: (() => void) | null = null;

const element = (id: string): HTMLElement => document.getElementById(id)!;
const scene = createScene();
const level = chooseLevel();
const connection = new Connection({
  locate: () => locateStream().catch(askForKey),
  onHello: (hello) => void welcome(hello),
  onState: (message) => {
    takeState(message.state ?? message);
  },
  onTrouble: (trouble) => {
    viewer.say(trouble.message);
  },
  onStatus: (status, detail) => {
    viewer.status = status;
    viewer.detail = detail;
    if (status === 'closed' && detail !== '') viewer.say(detail);
  },
  onFrameReady: () => {
    scene.wake();
  },
});
const commands = new Commands(
  viewer,
  (text) => connection.send(text),
  undefined,
  () => {
    takeStateLater.cancel();
  },
);
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
const edits = new Edits((key, reason) => {
  Reflect.deleteProperty(viewer.edits, key);
  viewer.say(reason);
});

function createScene(): Scene {
  try {
    return new Scene(element('face') as HTMLCanvasElement, {
      orbit: !page.bare,
      pixelRatio: page.pixelRatio,
      adaptive: !page.bare,
      still: page.still,
      view: page.view,
      light: page.light,
      ground: page.bare ? 'dark' : useTheme(viewer.theme),
      onTurning: (turning) => (viewer.turning = turning),
      onTrouble: (sentence) => {
        viewer.say(sentence);
      },
      placeOf: (name) => face?.landmarkPlace(name) ?? null,
      update,
    });
  } catch (error) {
    element('curtain').textContent = 'This browser cannot draw the face: it has no WebGL 2.';
    throw error;
  }
}

/** Find the session, or open one if there is none any more, and give the address of its stream. */
async function locateStream(): Promise<string> {
  if (session !== '') {
    const known = await api.session(session).catch((error: unknown) => {
      if (error instanceof ApiError && error.status === 404) return null;
      throw error;
    });
    if (known !== null) {
      await api.takeTicket(known.id);
      return streamOf(known);
    }
    if (isGuest()) throw new ApiError(404, 'This face was closed.');
  }
  viewer.step = { words: `Preparing ${who()}`, share: null };
  void tellOfStart();
  const opened = await api.openSession(viewer.rigName, viewer.alive);
  session = opened.id;
  const address = new URL(window.location.href);
  address.searchParams.set('session', session);
  address.searchParams.set('rig', viewer.rigName);
  window.history.replaceState(null, '', address);
  await api.takeTicket(session);
  return streamOf(opened);
}

/** Whether the page came by a link for one face. */
function isGuest(): boolean {
  return api.ticket !== '' && api.key === '';
}

/** Where the service wants to know who asks, ask them; the error goes on. */
function askForKey(error: unknown): never {
  if (error instanceof ApiError && error.status === 401) {
    viewer.locked = isGuest()
      ? 'This link is no longer valid. Ask for another one, or give a key.'
      : api.key === ''
        ? 'This service asks for a key.'
        : 'This key is not known here.';
    element('curtain').classList.remove('open');
  }
  throw error;
}

/** Say what the service is at for as long as it starts: a first start takes a minute. */
async function tellOfStart(): Promise<void> {
  for (;;) {
    const doing = await api.starting();
    if (doing === '' || viewer.surfaceReady) return;
    viewer.step = starting(doing);
    await new Promise((again) => setTimeout(again, START_POLL_MS));
  }
}

/** Whom the page is about to show: a person by name, anybody else as a face. */
function who(): string {
  const person = viewer.people.find(({ name }) => name === viewer.rigName);
  return person?.label ?? 'the face';
}

function streamOf(info: SessionInfo): string {
  return info.stream === undefined
    ? api.streamAddress(info.id)
    : api.address(info.stream).replace(/^http/, 'ws');
}

/** A hello, first or later: the face on the stage may be of another rig. */
async function welcome(hello: Hello): Promise<void> {
  viewer.session = session = hello.session;
  viewer.locked = '';
  viewer.keyed = api.key !== '' || api.ticket !== '';
  void countViewers();
  if (viewer.surfaceReady) element('curtain').classList.add('open');
  if (hello.role !== undefined) {
    viewer.role = hello.role;
    document.body.classList.toggle('watching', hello.role === 'read');
  }
  viewer.guest = isGuest();
  if (hello.state !== undefined) takeState(hello.state);
  const address = atLevel(api.place(hello.surface), level);
  try {
    // A live edit moves the session to another rig on the same surface; only a true hello may change it.
    if (hello.type === 'hello' && address !== surfaceAddress) await showFace(address);
    else if (!surfaceLoading) viewer.step = null;
    if (hello.rig !== rigId) await showRig(hello.rig, hello.type === 'hello');
    resume?.();
    resume = null;
  } catch (error) {
    viewer.step = null;
    viewer.say(error instanceof Error ? error.message : 'The face cannot be loaded.');
  }
}

async function showFace(address: string): Promise<void> {
  surfaceAddress = address;
  surfaceLoading = true;
  frameSeen = false;
  viewer.step = fetching(who(), 0, 0);
  const loaded = await Face.load(withTicket(address, api.ticket), (bytes, total) => {
    if (surfaceAddress === address) viewer.step = fetching(who(), bytes, total);
  }).catch((error: unknown) => {
    // The next hello may try again.
    if (surfaceAddress === address) surfaceAddress = '';
    throw error;
  });
  if (surfaceAddress !== address) {
    loaded.dispose();
    return;
  }
  face?.dispose();
  face = loaded;
  surfaceLoading = false;
  scene.add(face.root);
  scene.reframe();
  viewer.surfaceReady = true;
  viewer.regions = [...loaded.regionNames].sort();
  viewer.step = null;
  void loadMaps(loaded);
  // The frame that came while loading is still waiting, and is drawn now.
  await scene.rendered();
  const curtain = element('curtain').classList;
  if (!page.bare && !curtain.contains('open')) scene.enter();
  curtain.add('open');
}

async function showRig(id: string, isNew: boolean): Promise<void> {
  rigId = id;
  const described = await api.rig(id);
  if (rigId !== id) return;
  viewer.recipe = described.recipe;
  const rig = describeRig(described);
  muscles = described.muscles;
  showMuscles();
  if (isNew) {
    viewer.rig = rig;
    viewer.edits = {};
    if (viewer.rigName !== id) viewer.rigName = rig.name;
  } else if (viewer.rig !== null) {
    // An edit derived this rig. The first rig's numbers stay what the sliders count from.
    viewer.rig = { ...viewer.rig, id };
  }
}

/** What came while a control was in hand counts once the hand is off. */
const takeStateLater = debounce((state: FaceState) => {
  takeState(state);
}, HANDS_OFF_MS);

function takeState(state: FaceState): void {
  viewer.merged = state.merged ?? {};
  muscleView?.show(viewer.merged.muscles ?? {});
  if (muscleView !== null) scene.wake();
  viewer.facs = facsOf(state);
  takeStateLater.cancel();
  if (!commands.handsOff) {
    takeStateLater(state);
    return;
  }
  if (state.idle !== undefined) viewer.alive = state.idle !== null;
  viewer.sliders.take(state.layers?.puppet ?? {});
  const emotion = state.layers?.emotion?.emotion;
  viewer.emotion = expressionOf(emotion);
  if (emotion !== undefined) viewer.emotionIntensity = emotion.intensity;
  if (emotion?.found !== 'coordinates') viewer.feeling = null;
  // The point itself is known to whoever put it there; others see about where it lies.
  else viewer.feeling ??= middleOf(emotion.parts ?? [], viewer.places);
}

/** Take in what is new; tells whether it changed what is drawn. */
function update(): boolean {
  const faded = face?.stepFade(performance.now(), moving()) ?? false;
  if (face?.fading === true) scene.wake();
  const moved = applyNewestFrame();
  if (moved) muscleView?.move();
  const glows = muscleView?.step(performance.now()) ?? false;
  if (glows) scene.wake();
  return moved || faded || glows;
}

/** Draw the muscles of the face on the stage, if they are asked for. */
function showMuscles(): void {
  muscleView?.dispose();
  muscleView = null;
  if (viewer.inside && face !== null && muscles.length > 0) {
    const { restPoints: rest } = face;
    const shown = face;
    muscleView = new MuscleView(muscles, { rest, displacement: (at) => shown.displacement(at) });
    muscleView.show(viewer.merged.muscles ?? {});
    face.carry(muscleView.mesh);
  }
  scene.invalidate();
}

/** A visitor sees the maps fade in; a picture of the page need not wait, nor who wants no motion. */
function moving(): boolean {
  return !page.bare && !window.matchMedia('(prefers-reduced-motion: reduce)').matches;
}

/** Fetch the face's maps while it already shows; without them it stays as it is. */
async function loadMaps(shown: Face): Promise<void> {
  const missing = await shown.loadMaps((done, maps) => {
    if (shown === face) viewer.step = done < maps ? painting(done, maps) : null;
  });
  // A console note, and no notice: the face works without.
  // eslint-disable-next-line no-console
  if (missing !== '') console.warn(missing);
  if (shown === face) scene.wake();
}

/** What the device can do; a picture of the page shows all that there is. */
function chooseLevel(): Level {
  if (page.level !== null || page.bare) return page.level ?? 'high';
  const { deviceMemory } = navigator as Navigator & { deviceMemory?: number };
  return levelFor({
    memory: deviceMemory ?? null,
    screen: Math.min(window.screen.width, window.screen.height),
    touch: window.matchMedia('(pointer: coarse)').matches,
    graphics: scene.graphics,
  });
}

/** Tells whether the face changed. */
function applyNewestFrame(): boolean {
  if (face === null || surfaceLoading) return false;
  try {
    const frame = connection.takeFrame();
    if (frame === null) return false;
    const changed = face.apply(frame);
    frameSeen = true;
    tick = frame.tick;
    viewer.asleep = frame.asleep;
    viewer.tickRate = rate.at(frame.tick, performance.now());
    return changed;
  } catch (error) {
    viewer.say(error instanceof Error ? error.message : 'A frame cannot be drawn.');
    return false;
  }
}

const actions: Actions = {
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
      const read = text === '' ? { units: [], warnings: [] } : await api.readFacs(text, rigId);
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
  copy(text, what) {
    void copied(text).then((done) => {
      viewer.tell(
        done ? `${what} is on the clipboard.` : `The browser does not copy. ${what}: ${text}`,
      );
    });
  },
  setAlive: (alive) => {
    commands.setAlive(alive);
  },
  setTissue(path, value) {
    const key = path.join('.');
    viewer.edits[key] = value;
    edits.edit(key, () => api.patchTissue(session, tissuePatch(path, value)));
  },
  setTissueAge(age) {
    api
      .aged(rigId, age)
      .then(({ id }) => {
        actions.switchRig(id);
      })
      .catch(sayWhy);
  },
  setMuscleField(muscle, field, value) {
    const key = `${muscle}.${field}`;
    viewer.edits[key] = value;
    edits.edit(key, () => api.patchMuscle(session, muscle, { [field]: value }));
  },
  switchRig(rig) {
    if (rig === viewer.rigName && viewer.status === 'open') return;
    if (isGuest()) {
      viewer.say('This link is for one face. Open the page with a key to see others.');
      return;
    }
    const left = session;
    session = '';
    viewer.rigName = rig;
    resume = commands.carried();
    commands.forget();
    connection.connect();
    if (left !== '') api.closeSession(left).catch(() => undefined);
  },
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
        actions.switchRig(id);
      })
      .catch(sayWhy)
      .finally(() => (viewer.meeting = false));
  },
  setView(view) {
    viewer.view = view;
    scene.glideTo(view);
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
    showMuscles();
  },
  setTurning: (turning) => {
    scene.setTurning(turning);
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
    linkTo(role)
      .then((link) => {
        actions.copy(link, role === 'read' ? 'A link to watch' : 'A link to move this face');
      })
      .catch(sayWhy);
  },
  ...takeActions({
    timeline,
    performer,
    held: () => commands.held(),
    rig: () => ({ id: rigId, name: viewer.rig?.name ?? 'face' }),
    render: (clip, onProgress) => api.renderClip(clip, onProgress),
    offer,
    failed: (error) => {
      sayWhy(error);
    },
  }),
  reset() {
    commands.reset();
    viewer.say('');
    scene.glideTo(viewer.view);
  },
  reconnect: () => {
    connection.connect();
  },
  unlock(key) {
    api.key = key;
    window.sessionStorage.setItem(KEY_PLACE, key);
    viewer.locked = '';
    viewer.say('');
    connection.connect();
    if (!page.bare) void loadPeople();
    if (!page.bare) void loadFeelings();
  },
};

/** Make the person that the panel asks for, once its sliders rest; the newest wish counts. */
const becomePerson = debounce(() => {
  const asked = ++wishes;
  api
    .person(rigId, { ...wished })
    .then(({ id }) => {
      if (asked !== wishes) return;
      wished = {};
      actions.switchRig(id);
    })
    .catch(sayWhy);
}, PERSON_PAUSE_MS);

/** A link for others. Where no key is asked for, the page's own address moves the face. */
async function linkTo(role: 'read' | 'control'): Promise<string> {
  // A link makes no other links: it is handed on as it is.
  if (isGuest()) return window.location.href;
  if (role === 'read' || api.key !== '') return api.linkTo(session, role);
  const address = new URL(document.baseURI);
  address.search = new URLSearchParams({ session }).toString();
  return address.href;
}

/** Count who watches, now and again while somebody looks at this page. */
async function countViewers(): Promise<void> {
  if (page.bare || document.hidden || viewer.status !== 'open') return;
  const known = await api.session(session).catch(() => null);
  viewer.watching = known?.viewers ?? viewer.watching;
}

function sayWhy(error: unknown): void {
  viewer.say(error instanceof Error ? error.message : 'That did not work.');
}

window.__viewer = {
  get ready() {
    return viewer.surfaceReady && viewer.rig !== null && frameSeen;
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
  get textured() {
    return face?.mapsSettled ?? false;
  },
  get landmarks() {
    return face?.landmarks ?? {};
  },
  point: (which) => shownFace().point(which),
  drawnVertex: (index) => shownFace().drawnVertex(index),
  setView: (view) => {
    scene.setView(view);
  },
  setGround: (ground) => {
    scene.setGround(ground);
  },
  render: () => scene.rendered(),
};

function shownFace(): Face {
  if (face === null) throw new Error('The face is not loaded yet; wait for __viewer.ready.');
  return face;
}

/** List the people, once the service may be asked. */
async function loadPeople(): Promise<void> {
  try {
    const { people, attributes } = await api.people();
    viewer.attributes = attributes ?? {};
    viewer.people = people.map(({ name, title }) => ({ name, title, label: readable(name) }));
  } catch (error) {
    if (!(error instanceof ApiError && error.status === 401)) sayWhy(error);
  }
}

/** Put a timeline that was saved on the timeline again. */
async function openFile(file: File): Promise<void> {
  try {
    timeline.use(takeOf(await file.text()));
    viewer.tell(`${file.name} is in the timeline.`);
  } catch (error) {
    sayWhy(error);
  }
}

/** Learn where expressions lie among feelings; without that the plane has no signposts. */
async function loadFeelings(): Promise<void> {
  const { recipes } = await api.feelings().catch(() => ({ recipes: [] }));
  viewer.places = recipes.flatMap(({ name, valence, arousal, dominance = 0, anchor = false }) =>
    valence === undefined || arousal === undefined
      ? []
      : [{ name, valence, arousal, dominance, anchor }],
  );
}

element('curtain').textContent = '';
mount(Curtain, { target: element('curtain'), props: { viewer, actions } });
if (!page.bare) {
  element('face').addEventListener(
    'pointerdown',
    () => {
      element('drag').remove();
    },
    { once: true },
  );
  const place = (path: string): string => api.place(path);
  mount(StatusBar, { target: element('bar'), props: { viewer, actions, place } });
  window.setInterval(() => void countViewers(), COUNT_MS);
  onDeviceTheme(() => {
    scene.setGround(useTheme(viewer.theme));
  });
  const link = (path: string): string => api.address(path);
  mount(People, { target: element('people'), props: { viewer, actions, link } });
  void loadPeople();
  void loadFeelings();
  mount(Timeline, { target: element('timeline'), props: { viewer, timeline, actions } });
  takeDrops(
    (file) => void openFile(file),
    (over) => document.body.classList.toggle('dropping', over),
  );
  const shortcuts = shortcutsOf(viewer, actions);
  listenForShortcuts(shortcuts);
  mount(Keys, { target: document.body, props: { viewer, shortcuts } });
  mount(Panels, {
    target: element('panels'),
    props: { viewer, actions, link },
  });
}
connection.connect();
