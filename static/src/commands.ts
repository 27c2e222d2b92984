// What the sliders and buttons say to the face, as commands of one layer.

import type { Layer } from './protocol';
import { controlsCommand, emotionCommand, idleCommand, LAYERS, replaceCommand } from './protocol';
import type { Group } from './state/actions';
import type { ViewerState } from './state/viewer.svelte';
import { Throttle } from './throttle';

/** Each action unit of an emotion takes the time that it takes on living faces. */
const OWN_TIME = null;
const RELEASE_FADE_SECONDS = 0.2;
/** After a control was moved here, what the service reports of it is older than the hand for this long. */
const HANDS_OFF_MS = 700;

export class Commands {
  private readonly throttle: Throttle;
  private touchedAt = -Infinity;

  /**
   * @param send puts a text frame on the socket.
   * @param schedule as for Throttle.
   */
  constructor(
    private readonly viewer: ViewerState,
    private readonly send: (text: string) => void,
    schedule?: (run: () => void) => void,
  ) {
    this.throttle = new Throttle((groups) => {
      send(controlsCommand(groups));
    }, schedule);
  }

  /** Whether what the service reports may move the controls. */
  get handsOff(): boolean {
    return performance.now() - this.touchedAt >= HANDS_OFF_MS;
  }

  set(group: Group, name: string, value: number): void {
    this.touch();
    if (group === 'action_units') this.settleSides(name);
    this.hold(group, name, value);
  }

  letGo(group: Group, name: string): void {
    this.touch();
    const { sliders } = this.viewer;
    if (group === 'action_units') this.settleSides(name);
    Reflect.deleteProperty(sliders[group], name);
    this.throttle.clear();
    this.send(replaceCommand({ layer: 'puppet', fade: RELEASE_FADE_SECONDS, ...sliders.all() }));
  }

  playEmotion(label: string, intensity: number): void {
    this.touch();
    const fade = label === this.viewer.emotion ? 0 : OWN_TIME;
    this.viewer.emotion = label;
    this.send(emotionCommand(label, intensity, fade));
  }

  stopEmotion(): void {
    this.touch();
    this.viewer.emotion = '';
    this.release('emotion');
  }

  /** Have the face blink, look about and sway by itself, or leave it still. */
  setAlive(alive: boolean): void {
    this.touch();
    this.viewer.alive = alive;
    this.send(idleCommand(alive));
  }

  reset(): void {
    this.touch();
    this.forget();
    for (const layer of LAYERS) this.release(layer);
  }

  /** Put the controls back without a word to the face, for one that begins anew. */
  forget(): void {
    this.throttle.clear();
    this.viewer.sliders.take({});
    this.viewer.emotion = '';
  }

  /** What is held now, to be asked of another face: call it once that face has said hello. */
  carried(): () => void {
    const { emotion, emotionIntensity } = this.viewer;
    const controls = JSON.parse(JSON.stringify(this.viewer.sliders.all())) as ReturnType<
      ViewerState['sliders']['all']
    >;
    return () => {
      this.viewer.sliders.take(controls);
      if (emotion !== '') this.playEmotion(emotion, emotionIntensity);
      this.send(replaceCommand({ layer: 'puppet', fade: RELEASE_FADE_SECONDS, ...controls }));
    };
  }

  private touch(): void {
    this.touchedAt = performance.now();
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

  /** Hold a unit as a whole or by its sides, never both: AU12 beside L12 would say two things of the left. */
  private settleSides(name: string): void {
    const values = this.viewer.sliders.action_units;
    const number = name.replace(/^(AU|L|R)/, '');
    const [whole, left, right] = [`AU${number}`, `L${number}`, `R${number}`];
    if (name === whole) {
      for (const side of [left, right]) if (side in values) this.drop('action_units', side);
    } else if (whole in values) {
      const held = values[whole]!;
      this.drop('action_units', whole);
      for (const side of [left, right]) this.hold('action_units', side, held);
    }
  }
}
