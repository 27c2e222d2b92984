// Live edits of tissue and muscles: sent one after the other, once the slider has come to rest.

import { debounce } from './throttle';

const PAUSE_MS = 180;

export class Edits {
  private readonly waiting = new Map<string, () => Promise<unknown>>();
  /** Each edit derives a rig from the one before, so two may never be under way at once. */
  private last: Promise<void> = Promise.resolve();
  private readonly flush = debounce(() => {
    const edits = [...this.waiting];
    this.waiting.clear();
    for (const [key, send] of edits) {
      this.last = this.last.then(async () => {
        await send().catch((error: unknown) => {
          this.failed(key, error instanceof Error ? error.message : 'The edit failed.');
        });
      });
    }
  }, PAUSE_MS);

  /** @param failed is told which edit was refused, and why. */
  constructor(private readonly failed: (key: string, reason: string) => void) {}

  /** Edit what `key` names; a newer edit of the same replaces one that still waits. */
  edit(key: string, send: () => Promise<unknown>): void {
    this.waiting.set(key, send);
    this.flush();
  }
}
