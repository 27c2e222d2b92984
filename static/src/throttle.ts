// Gathers the edits of one animation frame into one command, the newest value of each name winning.

export type Groups = Record<string, Record<string, number>>;

export class Throttle {
  private pending: Groups = {};
  private scheduled = false;

  /**
   * @param flush gets everything gathered since the last call, e.g. `{action_units: {AU12: 0.4}}`.
   * @param schedule runs its argument once, a little later; an animation frame unless told.
   */
  constructor(
    private readonly flush: (groups: Groups) => void,
    private readonly schedule: (run: () => void) => void = (run) => requestAnimationFrame(run),
  ) {}

  set(group: string, name: string, value: number): void {
    (this.pending[group] ??= {})[name] = value;
    if (this.scheduled) return;
    this.scheduled = true;
    this.schedule(() => {
      this.scheduled = false;
      this.sendNow();
    });
  }

  /** Whether something was gathered that is not sent yet. */
  get waiting(): boolean {
    return Object.keys(this.pending).length > 0;
  }

  /** Send what was gathered without waiting for the frame. */
  sendNow(): void {
    const groups = this.pending;
    this.pending = {};
    if (Object.keys(groups).length > 0) this.flush(groups);
  }

  /** Forget what has not been sent. */
  clear(): void {
    this.pending = {};
  }
}

export interface Debounced<A extends unknown[]> {
  (...args: A): void;
  /** Leave out what still waits. */
  cancel(): void;
}

/** Run `action` once things have been quiet for `pauseMs`, with the arguments of the last call. */
export function debounce<A extends unknown[]>(
  action: (...args: A) => void,
  pauseMs: number,
): Debounced<A> {
  let timer: ReturnType<typeof setTimeout> | undefined;
  const later = (...args: A): void => {
    clearTimeout(timer);
    timer = setTimeout(() => {
      action(...args);
    }, pauseMs);
  };
  return Object.assign(later, {
    cancel: () => {
      clearTimeout(timer);
    },
  });
}
