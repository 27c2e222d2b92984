// Reconnecting, acknowledging and the newest frame, with a socket and a clock of our own.

import { readFileSync } from 'node:fs';
import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import type { ConnectionOptions, Socket, Status } from '../src/connection';
import { Connection } from '../src/connection';
import { ApiError } from '../src/refusal';

class FakeSocket implements Socket {
  binaryType: BinaryType = 'blob';
  readyState = 0;
  onopen: ((event: Event) => void) | null = null;
  onmessage: ((event: MessageEvent) => void) | null = null;
  onclose: ((event: CloseEvent) => void) | null = null;
  readonly sent: string[] = [];
  closedBy: number | undefined;

  send(text: string): void {
    this.sent.push(text);
  }

  close(code?: number): void {
    this.closedBy = code;
    this.readyState = 3;
  }

  opens(): void {
    this.readyState = 1;
    this.onopen?.({} as Event);
  }

  receives(data: string | ArrayBuffer): void {
    this.onmessage?.({ data } as MessageEvent);
  }

  breaks(code = 1006, reason = ''): void {
    this.readyState = 3;
    this.onclose?.({ code, reason } as CloseEvent);
  }
}

function golden(name: string): ArrayBuffer {
  const url = new URL(`../../tests/golden/frames/${name}.bin`, import.meta.url);
  return new Uint8Array(readFileSync(url)).buffer;
}

function frame(tick: number): ArrayBuffer {
  const data = golden('rest');
  new DataView(data).setUint32(4, tick, true);
  return data;
}

let sockets: FakeSocket[];
let statuses: Status[];
let locate: ReturnType<typeof vi.fn<() => Promise<string>>>;

function connect(more: Partial<ConnectionOptions> = {}): Connection {
  const connection = new Connection({
    locate,
    onHello: vi.fn(),
    onState: vi.fn(),
    onTrouble: vi.fn(),
    onStatus: (status) => statuses.push(status),
    onFrameReady: vi.fn(),
    open: () => {
      const socket = new FakeSocket();
      sockets.push(socket);
      return socket;
    },
    random: () => 1,
    ...more,
  });
  connection.connect();
  return connection;
}

const settled = (): Promise<unknown> => vi.advanceTimersByTimeAsync(0);
const last = (): FakeSocket => sockets.at(-1)!;

beforeEach(() => {
  vi.useFakeTimers();
  sockets = [];
  statuses = [];
  locate = vi.fn(() => Promise.resolve('ws://face'));
});

afterEach(() => {
  vi.useRealTimers();
});

describe('Connection', () => {
  it('opens, and hands on messages by type', async () => {
    const onHello = vi.fn();
    const onTrouble = vi.fn();
    connect({ onHello, onTrouble });
    await settled();
    last().opens();
    last().receives('{"type":"hello","session":"a"}');
    last().receives('{"type":"error","error":"x","message":"No."}');
    last().receives('{"type":"unheard-of"}');
    expect(statuses).toEqual(['connecting', 'open']);
    expect(last().binaryType).toBe('arraybuffer');
    expect(onHello).toHaveBeenCalledOnce();
    expect(onTrouble).toHaveBeenCalledOnce();
  });

  it('comes back after growing pauses, and asks again where the face is', async () => {
    connect();
    await settled();
    for (const pause of [250, 500, 1000, 2000]) {
      last().breaks();
      expect(statuses.at(-1)).toBe('waiting');
      const before = sockets.length;
      await vi.advanceTimersByTimeAsync(pause - 1);
      expect(sockets.length).toBe(before);
      await vi.advanceTimersByTimeAsync(1);
      expect(sockets.length).toBe(before + 1);
    }
    expect(locate).toHaveBeenCalledTimes(5);
  });

  it('never waits longer than ten seconds, and takes up to half off by chance', async () => {
    connect({ random: () => 0 });
    await settled();
    for (let i = 0; i < 12; i++) {
      last().breaks();
      await vi.advanceTimersByTimeAsync(5000);
    }
    expect(sockets.length).toBe(13);
  });

  it('starts with a short pause again after a connection that held', async () => {
    connect();
    await settled();
    last().breaks();
    await vi.advanceTimersByTimeAsync(250);
    last().opens();
    await vi.advanceTimersByTimeAsync(6000);
    last().breaks();
    await vi.advanceTimersByTimeAsync(250);
    expect(sockets.length).toBe(3);
  });

  it('waits when the service cannot be asked', async () => {
    locate.mockRejectedValueOnce(new Error('no answer'));
    connect();
    await settled();
    expect(sockets.length).toBe(0);
    expect(statuses).toEqual(['connecting', 'waiting']);
    await vi.advanceTimersByTimeAsync(250);
    expect(sockets.length).toBe(1);
  });

  it('says once, and asks no more, what the service refuses for good', async () => {
    const told: unknown[] = [];
    locate.mockRejectedValue(new ApiError(404, 'No rig is called nobody.'));
    const connection = connect({ onStatus: (...how) => told.push(how) });
    await vi.advanceTimersByTimeAsync(60_000);
    expect(locate).toHaveBeenCalledOnce();
    expect(told).toEqual([
      ['connecting', '', 0],
      ['closed', 'No rig is called nobody.', 404],
    ]);
    locate.mockResolvedValue('ws://face');
    connection.connect();
    await settled();
    expect(sockets.length).toBe(1);
  });

  it.each([0, 408, 409, 429, 500, 503])('asks again after %d', async (status) => {
    locate.mockRejectedValueOnce(new ApiError(status, 'Not now.'));
    connect();
    await vi.advanceTimersByTimeAsync(250);
    expect([locate.mock.calls.length, sockets.length]).toEqual([2, 1]);
  });

  it('leaves a service alone for as long as it asks, and then a little', async () => {
    locate.mockRejectedValueOnce(new ApiError(429, 'Many faces move.', 5));
    connect();
    await vi.advanceTimersByTimeAsync(5249);
    expect(locate).toHaveBeenCalledOnce();
    await vi.advanceTimersByTimeAsync(1);
    expect(locate).toHaveBeenCalledTimes(2);
  });

  it('comes back to one that wants to be left alone no sooner than it asks', async () => {
    locate.mockRejectedValueOnce(new ApiError(429, 'Many faces move.', 5));
    const connection = connect();
    await vi.advanceTimersByTimeAsync(1000);
    connection.close();
    connection.resume();
    await settled();
    expect([locate.mock.calls.length, statuses.at(-1)]).toEqual([1, 'waiting']);
    await vi.advanceTimersByTimeAsync(3999);
    expect(locate).toHaveBeenCalledOnce();
    await vi.advanceTimersByTimeAsync(1);
    expect(locate).toHaveBeenCalledTimes(2);
    connection.close();
    connection.resume();
    await settled();
    expect(locate).toHaveBeenCalledTimes(3);
  });

  it('stays closed when the service speaks another version', async () => {
    connect();
    await settled();
    last().breaks(1002, 'other version');
    await vi.advanceTimersByTimeAsync(60_000);
    expect(statuses.at(-1)).toBe('closed');
    expect(sockets.length).toBe(1);
  });

  it('leaves one face for another without listening to the first again', async () => {
    const onFrameReady = vi.fn();
    const connection = connect({ onFrameReady });
    await settled();
    const first = last();
    first.opens();
    connection.connect();
    await settled();
    expect(first.closedBy).toBe(1000);
    first.receives(frame(1));
    first.breaks();
    expect(onFrameReady).not.toHaveBeenCalled();
    expect(sockets.length).toBe(2);
  });

  it('keeps only the newest frame, and acknowledges the one that is used', async () => {
    const onFrameReady = vi.fn();
    const connection = connect({ onFrameReady });
    await settled();
    last().opens();
    for (const tick of [7, 8, 9]) last().receives(frame(tick));
    expect(onFrameReady).toHaveBeenCalledOnce();
    expect(last().sent).toEqual([]);
    expect(connection.takeFrame()?.tick).toBe(9);
    expect(last().sent).toEqual(['{"type":"ack","tick":9}']);
    expect(connection.takeFrame()).toBeNull();
  });

  it('asks for packed frames, and reads each, since the next one says what changed', async () => {
    const open = vi.fn(() => {
      const socket = new FakeSocket();
      sockets.push(socket);
      return socket;
    });
    const connection = connect({ open });
    await settled();
    expect(open).toHaveBeenLastCalledWith('ws://face?frames=packed');
    last().opens();
    last().receives(golden('packed-whole'));
    last().receives(golden('packed-change'));
    expect(connection.takeFrame()).toMatchObject({ tick: 3602, tongueThrust: 0.015625 });
    expect(last().sent).toEqual(['{"type":"ack","tick":3602}']);
  });

  it('says nothing of a change whose base it never had, until a whole frame comes', async () => {
    const connection = connect();
    await settled();
    last().opens();
    last().receives(golden('packed-whole'));
    last().breaks();
    await vi.advanceTimersByTimeAsync(1000);
    last().opens();
    last().receives(golden('packed-change'));
    expect(connection.takeFrame()).toBeNull();
    expect(last().sent).toEqual([]);
    last().receives(golden('packed-change'));
    last().receives(golden('packed-whole'));
    expect(connection.takeFrame()?.tick).toBe(3600);
  });

  it('does not send into a socket that is not open', async () => {
    const connection = connect();
    await settled();
    expect(connection.send('{}')).toBe(false);
    last().opens();
    expect(connection.send('{}')).toBe(true);
  });
});
