// Keeps one WebSocket to a face alive: finds it, reconnects with growing pauses, hands on the newest frame.

import type { Hello, StateMessage, ErrorMessage, WarningMessage } from './protocol';
import type { SurfaceFrame } from './surface-frame';
import { FrameReader, PACKED_QUERY, standsAlone } from './packed';
import { ackCommand, readMessage, SUBPROTOCOL } from './protocol';
import { answerOf, isFinal, restOf } from './refusal';

export type Status = 'connecting' | 'open' | 'waiting' | 'closed';

/** The part of WebSocket that is used; tests put their own in its place. */
export interface Socket {
  binaryType: BinaryType;
  readyState: number;
  onopen: ((event: Event) => void) | null;
  onmessage: ((event: MessageEvent) => void) | null;
  onclose: ((event: CloseEvent) => void) | null;
  send(text: string): void;
  close(code?: number, reason?: string): void;
}

export interface ConnectionOptions {
  /**
   * Address of the stream. Asked before each attempt, so that a face that is gone can be opened anew; an ApiError
   * that is final ends the attempts.
   */
  locate: () => Promise<string>;
  onHello: (hello: Hello) => void;
  onState: (state: StateMessage) => void;
  /** Something was refused, or obeyed only in part. */
  onTrouble: (trouble: ErrorMessage | WarningMessage) => void;
  /** @param answer of the service, where that is what is wrong; otherwise 0. */
  onStatus: (status: Status, detail: string, answer: number) => void;
  /** A newer frame lies ready for `takeFrame`. */
  onFrameReady: () => void;
  open?: (url: string) => Socket;
  random?: () => number;
}

const FIRST_PAUSE_MS = 250;
const LONGEST_PAUSE_MS = 10_000;
/** A service that wants to be left alone for longer is asked all the same. */
const LONGEST_REST_MS = 600_000;
/** A connection that lasted this long was a good one: the next pause is short again. */
const STEADY_MS = 5_000;
const SOCKET_OPEN = 1;
const CLOSE_PROTOCOL_ERROR = 1002;

export class Connection {
  private socket: Socket | null = null;
  private timer: ReturnType<typeof setTimeout> | null = null;
  private failures = 0;
  private openedAt = 0;
  /** Until when the service asked to be left alone, on the page's clock [ms], and as an answer to what. */
  private rest = { until: 0, reason: '', answer: 0 };
  /** Counts attempts, so that an answer to an abandoned one is not acted upon. */
  private attempt = 0;
  /** Frames since the last one that was taken, from the newest on that says all of a face. */
  private waiting: ArrayBuffer[] = [];
  private reader = new FrameReader();

  constructor(private readonly options: ConnectionOptions) {}

  /** Connect now, leaving whatever socket or pause there is. */
  connect(): void {
    this.leave();
    void this.try(++this.attempt);
  }

  /** Connect as soon as the service may be asked: for whoever comes back without a person's wish. */
  resume(): void {
    const { until, reason, answer } = this.rest;
    const left = until - Date.now();
    if (left <= 0) {
      this.connect();
      return;
    }
    this.abandon();
    this.tell('waiting', reason, answer);
    this.tryIn(left);
  }

  close(): void {
    this.abandon();
    this.tell('closed');
  }

  /** What is asked for is refused for good: say why, once, and ask no more. */
  giveUp(error: unknown): void {
    this.abandon();
    this.tell('closed', wordsOf(error), answerOf(error));
  }

  /** Send a text frame; false if there is no open socket, in which case nothing is kept. */
  send(text: string): boolean {
    if (this.socket?.readyState !== SOCKET_OPEN) return false;
    this.socket.send(text);
    return true;
  }

  /**
   * The newest frame since the last call, acknowledged; null if there is none.
   * Acknowledging when a frame is used, not when it comes, paces the server to what is really drawn.
   */
  takeFrame(): SurfaceFrame | null {
    let frame: SurfaceFrame | null = null;
    for (const each of this.waiting.splice(0)) frame = this.reader.read(each) ?? frame;
    if (frame !== null) this.send(ackCommand(frame.tick));
    return frame;
  }

  private async try(attempt: number): Promise<void> {
    this.tell('connecting');
    let url: string;
    try {
      url = await this.options.locate();
    } catch (error) {
      if (attempt === this.attempt) this.refused(error);
      return;
    }
    if (attempt === this.attempt) this.open(url);
  }

  private open(url: string): void {
    const make = this.options.open ?? ((address) => new WebSocket(address, SUBPROTOCOL) as Socket);
    const socket = make(url + (url.includes('?') ? '&' : '?') + PACKED_QUERY);
    this.socket = socket;
    this.reader = new FrameReader();
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => {
      this.openedAt = Date.now();
      this.tell('open');
    };
    socket.onmessage = (event) => {
      this.receive(event.data as string | ArrayBuffer);
    };
    socket.onclose = (event) => {
      if (this.socket === socket) this.lost(event);
    };
  }

  private receive(data: string | ArrayBuffer): void {
    if (typeof data !== 'string') {
      const wasEmpty = this.waiting.length === 0;
      if (standsAlone(data)) this.waiting = [];
      this.waiting.push(data);
      if (wasEmpty) this.options.onFrameReady();
      return;
    }
    const message = readMessage(data);
    if (message.type === 'hello' || message.type === 'rig') this.options.onHello(message);
    else if (message.type === 'state') this.options.onState(message);
    else if (message.type === 'error' || message.type === 'warning')
      this.options.onTrouble(message);
  }

  private lost(event: CloseEvent): void {
    this.socket = null;
    this.waiting = [];
    if (event.code === CLOSE_PROTOCOL_ERROR) {
      this.tell('closed', event.reason || 'The service speaks another version. Reload the page.');
      return;
    }
    if (this.openedAt > 0 && Date.now() - this.openedAt >= STEADY_MS) this.failures = 0;
    this.openedAt = 0;
    this.pause(event.reason);
  }

  private refused(error: unknown): void {
    if (isFinal(error)) this.giveUp(error);
    else this.pause(wordsOf(error), answerOf(error), restOf(error));
  }

  /** @param rest how long the service asked to be left alone at least [ms]. */
  private pause(reason: string, answer = 0, rest = 0): void {
    const longest = Math.min(LONGEST_PAUSE_MS, FIRST_PAUSE_MS * 2 ** this.failures);
    this.failures++;
    // Half of the pause is chance, so that many viewers do not come back in the same instant.
    const wait = longest * (0.5 + 0.5 * (this.options.random ?? Math.random)());
    const alone = Math.min(rest, LONGEST_REST_MS);
    this.rest = { until: Date.now() + alone, reason, answer };
    this.tell('waiting', reason, answer);
    this.tryIn(alone + wait);
  }

  private tryIn(milliseconds: number): void {
    this.timer = setTimeout(() => {
      this.timer = null;
      void this.try(++this.attempt);
    }, milliseconds);
  }

  private tell(status: Status, detail = '', answer = 0): void {
    this.options.onStatus(status, detail, answer);
  }

  private abandon(): void {
    this.attempt++;
    this.leave();
  }

  private leave(): void {
    if (this.timer !== null) clearTimeout(this.timer);
    this.timer = null;
    const socket = this.socket;
    this.socket = null;
    this.waiting = [];
    this.openedAt = 0;
    if (socket === null) return;
    socket.onopen = socket.onmessage = socket.onclose = null;
    socket.close(1000, 'The viewer left.');
  }
}

function wordsOf(error: unknown): string {
  return error instanceof Error ? error.message : '';
}
