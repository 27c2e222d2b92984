// Everything the panels show, as one reactive object.

import type { Held, Merged, Numbers } from '../protocol';
import type { Group } from './actions';
import type { AttributeInfo, Recipe } from '../recipe';
import type { Feeling, Place } from '../feelings';
import { InsideState } from './inside.svelte';
import type { Step } from './loading';
import type { LightName } from '../light-presets';
import type { Call } from '../retold';
import type { Theme } from '../theme';
import type { Rig } from './rig';

/** Someone whose face can be opened. */
export interface Person {
  /** Of the rig. */
  name: string;
  label: string;
  /** One line about them. */
  title: string;
}

/** Values that the visitor's own sliders hold. */
export class Sliders {
  action_units = $state<Numbers>({});
  muscles = $state<Numbers>({});
  jaw = $state<Numbers>({});
  gaze = $state<Numbers>({});
  head = $state<Numbers>({});
  tongue = $state<Numbers>({});

  /** Show what a layer holds, e.g. of a session that was open before. */
  take(held: Held): void {
    this.action_units = { ...held.action_units };
    this.muscles = { ...held.muscles };
    this.jaw = numbersOnly(held.jaw);
    this.gaze = numbersOnly(held.gaze);
    this.head = numbersOnly(held.head);
    this.tongue = numbersOnly(held.tongue);
  }

  /** All of them, as a command names them. */
  all(): Record<Group, Numbers> {
    const { action_units, muscles, jaw, gaze, head, tongue } = this;
    return $state.snapshot({ action_units, muscles, jaw, gaze, head, tongue });
  }
}

const NOTICE_MS = 9000;

export class ViewerState {
  status = $state<'connecting' | 'open' | 'waiting' | 'closed'>('connecting');
  /** Why it is waiting or closed, as the service says it; empty where it was left on purpose. */
  detail = $state('');
  /** The answer of the service that this is about; 0 where there was none. */
  answer = $state(0);
  /** The page stands in an element of another page, whose visitors read less than its author. */
  embedded = $state(false);
  session = $state('');
  /** Name or id that the session was opened on, e.g. `standard`. */
  rigName = $state('');
  people = $state.raw<Person[]>([]);
  /** What a person can be asked to look like. */
  attributes = $state.raw<Record<string, AttributeInfo>>({});
  /** What the one on the stage looks like; null for a face that has no recipe. */
  recipe = $state<Recipe | null>(null);
  /** A stranger is being made. */
  meeting = $state(false);
  rig = $state.raw<Rig | null>(null);
  surfaceReady = $state(false);
  /** What the page says while it asks for a key; empty where none is asked for. */
  locked = $state('');
  /** What is being done before the face is there, or before its skin is; null when all is. */
  step = $state.raw<Step | null>({ words: 'Connecting to the service', share: null });
  tickRate = $state(0);
  asleep = $state(false);
  /** Whether the face lives by itself while nobody asks anything of it. */
  alive = $state(false);
  /** One sentence about the last thing that went wrong; empty when all is well, or after a while. */
  notice = $state('');
  /** The notice tells of something that went well. */
  noticeGood = $state(false);
  /** The list of keys is open. */
  keysShown = $state(false);
  emotion = $state('');
  emotionIntensity = $state(1);
  /** Where the face lies among feelings while a point of them plays. */
  feeling = $state.raw<Feeling | null>(null);
  /** Recipes of expressions, and where they lie. */
  places = $state.raw<Place[]>([]);
  /** What the face is told to play, without its idle life, as FACS. */
  facs = $state('');
  canUndo = $state(false);
  canRedo = $state(false);
  view = $state('front');
  light = $state<LightName>('studio');
  theme = $state<Theme>('auto');
  /** The muscles are drawn over the face. */
  inside = $state(false);
  /** What else of the inside is seen. */
  readonly within = new InsideState();
  /** The turntable goes round. */
  turning = $state(false);
  /** How many pages and programs watch this face. */
  watching = $state(1);
  /** Whether this page may move the face. */
  role = $state<'read' | 'control'>('control');
  /** The page came by a link for one face. */
  guest = $state(false);
  /** Whether the service asks for a key. */
  keyed = $state(false);
  /** What the panels did last; null if nothing yet. */
  lastCall = $state.raw<Call | null>(null);
  /** What all layers come to together, also those that others write. */
  merged = $state.raw<Merged>({});
  sliders = new Sliders();
  /** Regions of the skin, whose tissue can be changed by itself. */
  regions = $state.raw<string[]>([]);
  /** Tissue and muscle numbers that were edited here, by `dermis.stiffness_low` or `muscle.force_scale`. */
  edits = $state<Numbers>({});
  private fading: ReturnType<typeof setTimeout> | undefined;

  /** Whether the service refused for good what the page asks for: it does not ask again by itself. */
  get isRefused(): boolean {
    return this.status === 'closed' && this.detail !== '';
  }

  /** Show a sentence for a while; an empty one takes the last away. */
  say(sentence: string): void {
    this.noticeGood = false;
    this.notice = sentence;
    clearTimeout(this.fading);
    if (sentence !== '') this.fading = setTimeout(() => (this.notice = ''), NOTICE_MS);
  }

  /** Say what an error says. */
  sayWhy(error: unknown): void {
    this.say(error instanceof Error ? error.message : 'That did not work.');
  }

  /** The same for what went well. */
  tell(sentence: string): void {
    this.say(sentence);
    this.noticeGood = true;
  }
}

function numbersOnly(values: object | undefined): Numbers {
  const entries = Object.entries(values ?? {}).filter(([, value]) => typeof value === 'number');
  return Object.fromEntries(entries) as Numbers;
}
