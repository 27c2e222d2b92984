// A hello, first or later: the face on the stage may be another, and so may its rig.

import type { Api } from '../api';
import type { Level } from '../level';
import { atLevel } from '../level';
import { mark } from '../marks';
import type { Hello } from '../protocol';
import { isFinal, restOf } from '../refusal';
import type { ViewerState } from '../state/viewer.svelte';
import { curtain } from './curtain';
import type { OnStage } from './on-stage';
import type { Opening } from './opening';
import type { Told } from './told';

/** A service that is busy, or a line that broke, may give a face the next time: so often it is asked again. */
const MOST_TRIES = 4;
/** Before the first of them; each waits twice as long as the one before [ms]. */
const TRY_AGAIN_MS = 1000;

export class Welcoming {
  /** Asks of a new face what the one before it did, so that two rigs can be compared. */
  resume: (() => void) | null = null;
  /** The last hello, or the last word of an edit: a slow face that comes later than it is not what the page is on. */
  private newest: Hello | null = null;
  /** The session whose face the panels describe. */
  private described = '';
  /** When what was asked for in vain is asked for again. */
  private again: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly api: Api,
    private readonly viewer: ViewerState,
    private readonly opening: Opening,
    private readonly stage: OnStage,
    private readonly told: Told,
    private readonly level: Level,
    /** The face that the page is on can never be shown. */
    private readonly giveUp: (error: unknown) => void,
  ) {}

  /** @param tries how often the face of this hello was asked for in vain. */
  async take(hello: Hello, tries = 0): Promise<void> {
    mark('hello');
    const { api, viewer, opening, stage, told } = this;
    // It asks for the face itself: a line that broke while that was waited for would have it asked for twice.
    if (hello.type === 'hello') clearTimeout(this.again);
    this.newest = hello;
    viewer.session = opening.session = hello.session;
    viewer.locked = '';
    viewer.keyed = api.key !== '' || api.ticket !== '';
    void opening.countViewers();
    if (viewer.surfaceReady) curtain.open();
    if (hello.role !== undefined) {
      viewer.role = hello.role;
      document.body.classList.toggle('watching', hello.role === 'read');
    }
    viewer.guest = opening.isGuest;
    if (hello.state !== undefined) told.take(hello.state);
    const address = atLevel(api.place(hello.surface), this.level);
    try {
      // A live edit moves the session to another rig on the same surface; only a true hello may change it.
      if (hello.type === 'hello' && address !== stage.address) await stage.show(address);
      else if (!stage.loading) viewer.step = null;
      // The hello whose face is on its way describes the rig of that edit too.
      else if (hello.type === 'rig') return;
      if (!this.isLeft(hello)) await this.describe(hello);
      if (!this.isLeft(hello)) {
        this.resume?.();
        this.resume = null;
      }
      // The next face may be the same head, on its way for both.
      void stage.finish();
    } catch (error) {
      const left = this.isLeft(hello);
      if (left && stage.address !== '') return;
      viewer.step = null;
      void stage.finish();
      viewer.say(error instanceof Error ? error.message : 'The face cannot be loaded.');
      const rest = restOf(error);
      if (!isFinal(error)) this.tryAgain(left ? (this.newest ?? hello) : hello, tries, rest);
      else if (!left && hello.type === 'hello') this.giveUp(error);
    }
  }

  /** Whether the page has gone on to another face since. */
  private isLeft(hello: Hello): boolean {
    return this.opening.session !== hello.session;
  }

  /** Describe the rig that the session is on by now. */
  private async describe(hello: Hello): Promise<void> {
    const { told } = this;
    const rig = this.newest?.rig ?? hello.rig;
    if (rig === told.rigId) return;
    await told.showRig(rig, hello.type === 'hello' || this.described !== hello.session);
    if (told.rigId === rig) this.described = hello.session;
  }

  /**
   * Unless the page has gone on to another face meanwhile.
   * @param rest how long the service asked to be left alone at least [ms].
   */
  private tryAgain(hello: Hello, tries: number, rest: number): void {
    if (tries >= MOST_TRIES) return;
    clearTimeout(this.again);
    this.again = setTimeout(
      () => {
        const { stage, told, viewer } = this;
        const missing = stage.address === '' || told.rigId === '';
        if (this.isLeft(hello) || !missing) return;
        viewer.say('');
        // An edit may have moved the session to another rig meanwhile.
        void this.take({ ...hello, rig: this.newest?.rig ?? hello.rig }, tries + 1);
      },
      Math.max(TRY_AGAIN_MS * 2 ** tries, rest),
    );
  }
}
