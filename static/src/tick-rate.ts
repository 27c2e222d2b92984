// How many ticks of the face a second arrive.

const WINDOW_MS = 2000;

export class TickRate {
  private readonly seen: { tick: number; time: number }[] = [];
  private shown = 0;

  /**
   * Take note of a frame.
   * @param time of its arrival [ms].
   * @returns ticks per second over about the last two seconds; it changes at most four times a second, to be readable.
   */
  at(tick: number, time: number): number {
    const last = this.seen.at(-1);
    if (last !== undefined && (tick < last.tick || time - last.time > WINDOW_MS))
      this.seen.length = 0;
    this.seen.push({ tick, time });
    while (this.seen.length > 2 && time - this.seen[0]!.time > WINDOW_MS) this.seen.shift();
    const first = this.seen[0]!;
    if (time - first.time >= WINDOW_MS / 4) {
      this.shown = Math.round(((tick - first.tick) * 1000) / (time - first.time));
    }
    return this.shown;
  }
}
