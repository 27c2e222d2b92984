// Somebody beside the face: a moment of itself that is held, or the paper's literal face under the same commands.

import type { Api } from '../api';
import { Connection } from '../connection';
import { Face } from '../face';
import type { FacePose } from '../pose';
import type { Level } from '../level';
import { atLevel } from '../level';
import type { Hello } from '../protocol';
import type { Scene } from '../scene';
import { sketch } from '../sketch';
import type { Beside } from '../state/inside.svelte';
import type { ViewerState } from '../state/viewer.svelte';
import { withTicket } from '../ticket';
import type { Overlay } from './on-stage';

export interface BesideParts {
  api: Api;
  viewer: ViewerState;
  scene: Scene;
  level: Level;
  /** Address of the surface on the stage. */
  address: () => string;
  /** The newest frame that was drawn; null before the first. */
  pose: () => FacePose | null;
  /** Say all that is held once more, so that a new face learns of it. */
  repeat: () => void;
}

const PAPER = 'paper';

export class BesideOverlay implements Overlay {
  private face: Face | null = null;
  private other: Face | null = null;
  private shown: Beside = 'off';
  private moment: FacePose | null = null;
  private connection: Connection | null = null;
  private session = '';
  /** Gives who came while faces were sketched their own materials. */
  private uncoverOther: (() => void) | null = null;
  /** Counts what was asked for, so that what comes too late is left out. */
  private asked = 0;

  constructor(private readonly parts: BesideParts) {}

  wear(face: Face | null): void {
    const { within } = this.parts.viewer;
    if (this.face !== null) {
      this.moment = null;
      within.held = false;
      if (within.beside === 'held') within.beside = 'off';
    }
    this.face = face;
    this.refresh();
  }

  /** Keep the moment that is shown; tells whether there is one. */
  hold(): boolean {
    this.moment = this.parts.pose();
    if (this.shown === 'held' && this.moment !== null) this.other?.apply(this.moment);
    this.parts.scene.invalidate();
    return this.moment !== null;
  }

  drop(): void {
    const { within } = this.parts.viewer;
    this.moment = null;
    if (within.beside === 'held') within.beside = 'off';
    this.refresh();
  }

  /** Show whom the panel asks for. */
  refresh(): void {
    const { viewer, scene } = this.parts;
    const wanted = viewer.within.beside;
    if (wanted !== this.shown) {
      this.leave();
      this.shown = wanted;
      if (wanted === 'held') void this.showMoment();
      if (wanted === 'paper') this.showPaper();
    }
    scene.pair(
      wanted === 'off' ? null : { left: this.other?.root ?? null, right: this.face?.root ?? null },
    );
  }

  /** The same command for who stands beside. */
  tell(text: string): void {
    // A life of its own would make two faces of the same commands differ.
    if (!text.includes('"type":"idle"')) this.connection?.send(text);
  }

  move(): void {
    // The face itself is drawn by the stage.
  }

  step(): boolean {
    const frame = this.other === null ? null : (this.connection?.takeFrame() ?? null);
    const faded = this.other?.stepFade(performance.now(), false) ?? false;
    return (frame !== null && this.other!.apply(frame)) || faded;
  }

  uncovered(): void {
    if (this.uncoverOther === null) return;
    this.uncoverOther();
    this.uncoverOther = null;
    this.loadMaps(this.other!);
  }

  private async showMoment(): Promise<void> {
    const loaded = await this.load(this.parts.address());
    if (loaded !== null && this.moment !== null) loaded.apply(this.moment);
  }

  private showPaper(): void {
    const { api, scene, repeat } = this.parts;
    this.connection = new Connection({
      locate: async () => {
        const opened = await api.openSession(PAPER, false);
        this.session = opened.id;
        const ticket = await api.ticketOf(opened.id);
        return withTicket(api.place(`api/sessions/${opened.id}/stream`), ticket).replace(
          /^http/,
          'ws',
        );
      },
      onHello: (hello: Hello) => {
        void this.load(atLevel(api.place(hello.surface), this.parts.level)).then(() => {
          repeat();
          scene.wake();
        });
      },
      // The face on the stage tells of all this.
      onState: () => undefined,
      onTrouble: () => undefined,
      onStatus: () => undefined,
      onFrameReady: () => {
        scene.wake();
      },
    });
    this.connection.connect();
  }

  private async load(address: string): Promise<Face | null> {
    const { api, scene, viewer } = this.parts;
    const asked = ++this.asked;
    try {
      const loaded = await Face.load(withTicket(address, api.ticket));
      if (asked !== this.asked) {
        loaded.dispose();
        return null;
      }
      this.other?.dispose();
      this.other = loaded;
      scene.add(loaded.root);
      if (scene.plain) this.uncoverOther = sketch(loaded.root, loaded.peelCut);
      else this.loadMaps(loaded);
      scene.pair({ left: loaded.root, right: this.face?.root ?? null });
      viewer.within.arrived = true;
      return loaded;
    } catch (error) {
      if (asked === this.asked) viewer.sayWhy(error);
      return null;
    }
  }

  private loadMaps(face: Face): void {
    void face.loadMaps().then(() => {
      this.parts.scene.wake();
    });
  }

  private leave(): void {
    this.asked++;
    this.uncoverOther = null;
    this.connection?.close();
    this.connection = null;
    if (this.session !== '') this.parts.api.closeSession(this.session).catch(() => undefined);
    this.session = '';
    this.other?.dispose();
    this.other = null;
    this.parts.viewer.within.arrived = false;
  }
}
