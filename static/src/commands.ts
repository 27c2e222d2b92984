// What the sliders and buttons say to the face, as commands of one layer.

import type { Held, Layer, Numbers } from './protocol';
import {
  controlsCommand,
  emotionCommand,
  feelingCommand,
  idleCommand,
  LAYERS,
  replaceCommand,
} from './protocol';
import { callOf } from './retold';
import { settledSides } from './sides';
import type { Snapshot } from './snapshot';
import { heldOf, snapshotOf } from './snapshot';
import type { Group } from './state/actions';
import type { Feeling } from './feelings';
import { dominanceAt } from './feelings';
import { History } from './state/history';
import type { Cue, Held as Played } from './take';
import type { ViewerState } from './state/viewer.svelte';
import { Throttle } from './throttle';
import { Unheard } from './unheard';

/** Each action unit of an emotion takes the time that it takes on living faces. */
const OWN_TIME = null;
const RELEASE_FADE_SECONDS = 0.2;
/** A face that is led through feelings is always this far behind the hand. */
const FEELING_FADE_SECONDS = 0.15;
const FACS_FADE_SECONDS = 0.3;
/** After a control was moved here, what the service reports of it is older than the hand for this long. */
export const HANDS_OFF_MS = 700;

export class Commands {
  private readonly throttle: Throttle;
  /** The newest point among feelings, until the next frame says it. */
  private readonly felt: Throttle;
  private readonly history = new History<Snapshot>();
  private readonly unheard = new Unheard();
  private touchedAt = -Infinity;

  /**
   * @param put puts a text frame on the socket.
   * @param schedule as for Throttle.
   */
  constructor(
    private readonly viewer: ViewerState,
    private readonly put: (text: string) => void,
    schedule?: (run: () => void) => void,
    /** Called whenever a control is moved, and when that is sent: what was reported before is old. */
    private readonly touched: () => void = () => undefined,
  ) {
    this.throttle = new Throttle((groups) => {
      this.touch();
      this.unheard.say(groups);
      this.send(controlsCommand(groups));
    }, schedule);
    this.felt = new Throttle(({ feeling }) => {
      const { valence = 0, arousal = 0 } = feeling ?? {};
      this.sendFeeling({ valence, arousal }, FEELING_FADE_SECONDS);
    }, schedule);
  }

  /** Whether a report of what this layer holds may move the controls: no hand is on them, and it has heard them all. */
  mayFollow(held: Held): boolean {
    const handsOff = performance.now() - this.touchedAt >= HANDS_OFF_MS;
    return handsOff && !this.throttle.waiting && !this.felt.waiting && this.unheard.isIn(held);
  }

  set(group: Group, name: string, value: number): void {
    this.note(`${group}.${name}`);
    this.touch();
    if (group === 'action_units') this.settleSides(name);
    this.hold(group, name, value);
  }

  letGo(group: Group, name: string): void {
    this.note(`let go of ${group}.${name}`);
    this.touch();
    const { sliders } = this.viewer;
    if (group === 'action_units') this.settleSides(name);
    Reflect.deleteProperty(sliders[group], name);
    this.leaveWaiting();
    this.send(replaceCommand({ layer: 'puppet', fade: RELEASE_FADE_SECONDS, ...sliders.all() }));
  }

  playEmotion(label: string, intensity: number): void {
    this.note(`emotion ${label}`);
    this.touch();
    this.startEmotion(label, intensity);
  }

  stopEmotion(): void {
    this.note('no emotion');
    this.touch();
    this.endEmotion();
  }

  /** Play the face of a point among feelings. */
  feel(valence: number, arousal: number): void {
    this.note('feeling');
    this.touch();
    this.viewer.emotion = '';
    this.viewer.feeling = { valence, arousal };
    this.felt.set('feeling', 'valence', valence);
    this.felt.set('feeling', 'arousal', arousal);
  }

  /** Play these units and no others, whatever plays as an emotion; pose and muscles stay. */
  playUnits(units: Numbers): void {
    this.note('FACS');
    this.touch();
    const { sliders } = this.viewer;
    this.leaveWaiting();
    if (this.viewer.emotion !== '' || this.viewer.feeling !== null) this.endEmotion();
    sliders.action_units = { ...units };
    this.send(replaceCommand({ layer: 'puppet', fade: FACS_FADE_SECONDS, ...sliders.all() }));
  }

  /** Have the face itself read a FACS string and play it in place of what plays. */
  playText(facs: string): void {
    this.note('FACS');
    this.leaveWaiting();
    if (this.viewer.emotion !== '' || this.viewer.feeling !== null) this.endEmotion();
    const { muscles, jaw, gaze, head, tongue } = this.viewer.sliders.all();
    const rest = { muscles, jaw, gaze, head, tongue };
    this.send(replaceCommand({ layer: 'puppet', fade: FACS_FADE_SECONDS, facs, ...rest }));
  }

  /** What the controls hold, and what plays as an emotion. */
  held(): Played {
    return heldOf(this.viewer);
  }

  /** Go through a performance: nothing that is done here is undone later, and nothing is told. */
  perform(pose: Partial<Record<Group, Numbers>>, fade: number): void {
    // What a hand has just moved is said before, lest it stand here and not on the face.
    this.throttle.sendNow();
    this.unheard.forget();
    this.touch();
    for (const [group, values] of Object.entries(pose) as [Group, Numbers][]) {
      for (const [name, value] of Object.entries(values)) {
        if (value === 0) Reflect.deleteProperty(this.viewer.sliders[group], name);
        else this.viewer.sliders[group][name] = value;
      }
    }
    this.put(controlsCommand({ ...pose, fade }));
  }

  /** The same for what plays as an emotion. */
  performCue(plays: Cue['plays']): void {
    this.touch();
    this.felt.clear();
    this.viewer.emotion = '';
    this.viewer.feeling = null;
    if (plays === null) {
      this.put(replaceCommand({ layer: 'emotion', fade: RELEASE_FADE_SECONDS }));
    } else if ('label' in plays) {
      this.viewer.emotion = plays.label;
      this.viewer.emotionIntensity = plays.intensity;
      this.put(emotionCommand(plays.label, plays.intensity, OWN_TIME));
    } else {
      this.viewer.feeling = { valence: plays.valence, arousal: plays.arousal };
      this.put(feelingCommand(plays, FEELING_FADE_SECONDS));
    }
  }

  undo(): void {
    this.goTo(this.history.undo(snapshotOf(this.viewer)));
  }

  redo(): void {
    this.goTo(this.history.redo(snapshotOf(this.viewer)));
  }

  /** Have the face blink, look about and sway by itself, or leave it still. */
  setAlive(alive: boolean): void {
    this.touch();
    this.viewer.alive = alive;
    this.send(idleCommand(alive));
  }

  reset(): void {
    this.note('reset');
    this.touch();
    this.forget();
    for (const layer of LAYERS) this.release(layer);
  }

  /** Put the controls back without a word to the face, for one that begins anew. */
  forget(): void {
    this.leaveWaiting();
    this.felt.clear();
    this.viewer.sliders.take({});
    this.viewer.emotion = '';
    this.viewer.feeling = null;
  }

  /** What is held now, to be asked of another face: call it once that face has said hello. */
  carried(): () => void {
    const held = snapshotOf(this.viewer);
    return () => {
      this.restore(held);
    };
  }

  /** All that is held is said as a whole: what was not sent, or not heard, does not matter any more. */
  private leaveWaiting(): void {
    this.throttle.clear();
    this.unheard.forget();
  }

  private note(gesture: string): void {
    this.history.note(gesture, () => snapshotOf(this.viewer));
    this.tellHistory();
  }

  private tellHistory(): void {
    this.viewer.canUndo = this.history.canUndo;
    this.viewer.canRedo = this.history.canRedo;
  }

  private goTo(snapshot: Snapshot | null): void {
    if (snapshot !== null) this.restore(snapshot);
    this.tellHistory();
  }

  /** Have the face do what it did when `held` was taken. */
  private restore({ controls, emotion, intensity, feeling }: Snapshot): void {
    this.touch();
    this.leaveWaiting();
    this.felt.clear();
    const { viewer } = this;
    const playing = viewer.emotion !== '' || viewer.feeling !== null;
    viewer.sliders.take(controls);
    viewer.emotionIntensity = intensity;
    if (emotion !== '') this.startEmotion(emotion, intensity);
    else if (feeling !== null) {
      viewer.feeling = feeling;
      viewer.emotion = '';
      this.sendFeeling(feeling, RELEASE_FADE_SECONDS);
    } else if (playing) this.endEmotion();
    this.send(replaceCommand({ layer: 'puppet', fade: RELEASE_FADE_SECONDS, ...controls }));
  }

  private startEmotion(label: string, intensity: number): void {
    const fade = label === this.viewer.emotion ? 0 : OWN_TIME;
    this.felt.clear();
    this.viewer.emotion = label;
    this.viewer.feeling = null;
    this.send(emotionCommand(label, intensity, fade));
  }

  private sendFeeling(point: Feeling, fade: number): void {
    const dominance = dominanceAt(point, this.viewer.places);
    this.send(feelingCommand({ ...point, dominance }, fade));
  }

  private endEmotion(): void {
    this.felt.clear();
    this.viewer.emotion = '';
    this.viewer.feeling = null;
    this.release('emotion');
  }

  private send(text: string): void {
    this.viewer.lastCall = callOf(text) ?? this.viewer.lastCall;
    this.put(text);
  }

  private touch(): void {
    this.touchedAt = performance.now();
    this.touched();
    // A page that is kept busy meanwhile has reports waiting that are older still: it counts from when it is free.
    setTimeout(() => {
      this.touchedAt = performance.now();
    });
  }

  private release(layer: Layer): void {
    this.send(replaceCommand({ layer, fade: RELEASE_FADE_SECONDS }));
  }

  private hold(group: Group, name: string, value: number): void {
    this.viewer.sliders[group][name] = value;
    this.throttle.set(group, name, value);
  }

  /** Zero lets go of units and muscles. */
  private drop(group: Group, name: string): void {
    Reflect.deleteProperty(this.viewer.sliders[group], name);
    this.throttle.set(group, name, 0);
  }

  private settleSides(name: string): void {
    const { dropped, held } = settledSides(this.viewer.sliders.action_units, name);
    for (const side of dropped) this.drop('action_units', side);
    for (const [side, value] of held) this.hold('action_units', side, value);
  }
}
