// Sends what was said last: one change at a time is under way, and what comes meanwhile is one change after it.

export class Newest<T extends object> {
  private readonly waiting = new Map<string, T>();
  private running = false;

  /**
   * @param send does what was asked of one thing.
   * @param failed is told which, and why not; the rest goes on.
   */
  constructor(
    private readonly send: (key: string, change: T) => Promise<unknown>,
    private readonly failed: (key: string, error: unknown) => void,
  ) {}

  /** Nothing waits, and nothing is under way. */
  get idle(): boolean {
    return !this.running && this.waiting.size === 0;
  }

  /** Change something; of each of its fields the newest value is sent. */
  put(key: string, change: T): void {
    this.waiting.set(key, { ...this.waiting.get(key), ...change });
    if (!this.running) void this.run();
  }

  private async run(): Promise<void> {
    this.running = true;
    for (;;) {
      const next = this.waiting.entries().next();
      if (next.done === true) break;
      const [key, change] = next.value;
      this.waiting.delete(key);
      await this.send(key, change).catch((error: unknown) => {
        this.failed(key, error);
      });
    }
    this.running = false;
  }
}
