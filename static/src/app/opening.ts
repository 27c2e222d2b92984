// Which session the page is on: found or opened, with a key or a ticket, and handed on as a link.

import type { Api, SessionInfo } from '../api';
import { mark } from '../marks';
import { ApiError } from '../refusal';
import { starting } from '../state/loading';
import type { ViewerState } from '../state/viewer.svelte';
import type { PageOptions } from '../url';

/** Where the key is kept: as long as the tab is open, and for this page only. */
const KEY_PLACE = 'risorius.key';
const START_POLL_MS = 500;
/** So long after a page has left a face, its own socket no longer counts there. */
const LEAVING_MS = 1000;

export class Opening {
  /** The session to attach to; empty to open one. */
  session: string;
  /** Nobody will see what is opened. */
  private abandoned = false;

  constructor(
    private readonly page: PageOptions,
    private readonly api: Api,
    private readonly viewer: ViewerState,
    /** The page asks who is there: nothing may lie over the question. */
    private readonly onLocked: () => void,
  ) {
    this.session = page.session ?? '';
    if (!page.embed) api.key = window.sessionStorage.getItem(KEY_PLACE) ?? '';
  }

  /** Whether the page came by a link for one face. */
  get isGuest(): boolean {
    return this.api.ticket !== '' && this.api.key === '';
  }

  /** Whom the page is about to show: a person by name, anybody else as a face. */
  get who(): string {
    const person = this.viewer.people.find(({ name }) => name === this.viewer.rigName);
    return person?.label ?? 'the face';
  }

  /** Find the session, or open one if there is none any more, and give the address of its stream. */
  locate(): Promise<string> {
    return this.find()
      .then((address) => {
        mark('session');
        return address;
      })
      .catch((error: unknown) => this.askForKey(error));
  }

  useKey(key: string): void {
    this.api.key = key;
    if (!this.page.embed) window.sessionStorage.setItem(KEY_PLACE, key);
  }

  /** A link for others. Where no key is asked for, the page's own address moves the face. */
  async link(role: 'read' | 'control'): Promise<string> {
    // A link makes no other links: it is handed on as it is.
    if (this.isGuest) return window.location.href;
    if (role === 'read' || this.api.key !== '') return this.api.linkTo(this.session, role);
    const address = new URL(document.baseURI);
    address.search = new URLSearchParams({ session: this.session }).toString();
    return address.href;
  }

  /** Close a session that this page has left, unless others watch it: then it stays theirs. */
  leave(session: string): void {
    if (session !== '') setTimeout(() => void this.closeUnwatched(session), LEAVING_MS);
  }

  /** The page shows nothing: a session that is being opened for it is closed again. */
  abandon(): void {
    this.abandoned = true;
  }

  /** Count who watches, where somebody looks at this page. */
  async countViewers(): Promise<void> {
    if (this.page.bare || document.hidden || this.viewer.status !== 'open') return;
    const known = await this.api.session(this.session).catch(() => null);
    this.viewer.watching = known?.viewers ?? this.viewer.watching;
  }

  private async closeUnwatched(session: string): Promise<void> {
    const known = await this.api.session(session).catch(() => null);
    if (known?.viewers === 0) await this.api.closeSession(session).catch(() => undefined);
  }

  private async find(): Promise<string> {
    const { api, viewer } = this;
    if (this.session !== '') {
      const known = await api.session(this.session).catch((error: unknown) => {
        if (error instanceof ApiError && error.status === 404) return null;
        throw error;
      });
      if (known !== null) {
        await api.takeTicket(known.id);
        return this.streamOf(known);
      }
      // An element that was given a face shows that one, or none.
      const given = this.page.embed && this.session === this.page.session;
      if (this.isGuest || given) throw new ApiError(404, 'This face was closed.');
    }
    viewer.step = { words: `Preparing ${this.who}`, share: null };
    void this.tellOfStart();
    const opened = await api.openSession(viewer.rigName, viewer.alive);
    if (this.abandoned) {
      await this.closeUnwatched(opened.id);
      throw new Error('Nothing can be drawn here.');
    }
    this.session = opened.id;
    const address = new URL(window.location.href);
    address.searchParams.set('session', this.session);
    address.searchParams.set('rig', viewer.rigName);
    window.history.replaceState(null, '', address);
    await api.takeTicket(this.session);
    return this.streamOf(opened);
  }

  private streamOf(info: SessionInfo): string {
    return info.stream === undefined
      ? this.api.streamAddress(info.id)
      : this.api.address(info.stream).replace(/^http/, 'ws');
  }

  /** Where the service wants to know who asks, ask them; the error goes on. */
  private askForKey(error: unknown): never {
    if (error instanceof ApiError && error.status === 401) {
      this.viewer.locked = this.isGuest
        ? 'This link is no longer valid. Ask for another one, or give a key.'
        : this.api.key === ''
          ? 'This service asks for a key.'
          : 'This key is not known here.';
      this.onLocked();
    }
    throw error;
  }

  /** Say what the service is at for as long as it starts: a first start takes a minute. */
  private async tellOfStart(): Promise<void> {
    for (;;) {
      const doing = await this.api.starting();
      if (doing === '' || this.viewer.surfaceReady) return;
      this.viewer.step = starting(doing);
      await new Promise((again) => setTimeout(again, START_POLL_MS));
    }
  }
}
