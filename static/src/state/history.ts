// What can be undone: states before each gesture, and the ones that were left by undoing.

/** Moves of one control that follow each other within this are one gesture [ms]. */
const ONE_GESTURE_MS = 800;
const MOST_KEPT = 100;

export class History<T> {
  private readonly before: T[] = [];
  private after: T[] = [];
  private gesture = '';
  private movedAt = -Infinity;

  get canUndo(): boolean {
    return this.before.length > 0;
  }

  get canRedo(): boolean {
    return this.after.length > 0;
  }

  /**
   * A control is about to be moved.
   * @param gesture what is moved; the same again within a moment belongs to the gesture before.
   * @param state gives all as it stands; asked only where a gesture begins.
   */
  note(gesture: string, state: () => T, now = performance.now()): void {
    const goesOn = gesture === this.gesture && now - this.movedAt < ONE_GESTURE_MS;
    this.gesture = gesture;
    this.movedAt = now;
    if (goesOn) return;
    this.before.push(state());
    if (this.before.length > MOST_KEPT) this.before.shift();
    this.after = [];
  }

  /** The state before the last gesture; null if there is none. @param now what is left for it. */
  undo(now: T): T | null {
    return this.step(this.before, this.after, now);
  }

  /** The state that was left by the last undoing. */
  redo(now: T): T | null {
    return this.step(this.after, this.before, now);
  }

  private step(from: T[], to: T[], now: T): T | null {
    this.gesture = '';
    const found = from.pop();
    if (found === undefined) return null;
    to.push(now);
    return found;
  }
}
