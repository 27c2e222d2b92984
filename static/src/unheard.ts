// What was asked of the face and is not yet in what the service reports: such a report is older than the hand.

import type { Held, Numbers } from './protocol';
import type { Groups } from './throttle';

/** A service that does not show by then what it was asked has its reasons, and is believed [ms]. */
const BELIEVED_AFTER_MS = 3000;
/** Reports and commands are rounded on their way. */
const SAME = 0.006;

export class Unheard {
  private values: Groups = {};
  private saidAt = -Infinity;

  /** These were sent. */
  say(groups: Groups, now = performance.now()): void {
    for (const [group, values] of Object.entries(groups)) {
      this.values[group] = { ...this.values[group], ...values };
    }
    this.saidAt = now;
  }

  /** What is held is sent as a whole: nothing before it matters. */
  forget(): void {
    this.values = {};
  }

  /** Tells whether a report is from before what was sent; one that is not has heard it all. */
  isIn(held: Held, now = performance.now()): boolean {
    if (now - this.saidAt > BELIEVED_AFTER_MS || this.areIn(held)) this.forget();
    return Object.keys(this.values).length === 0;
  }

  private areIn(held: Held): boolean {
    return Object.entries(this.values).every(([group, values]) => {
      const told = (held[group as keyof Held] ?? {}) as Numbers;
      return Object.keys(values).every((name) => isHeard(told, values, name));
    });
  }
}

/** Whether a control is told as it was said; sides that hold the same are told as the whole. */
function isHeard(told: Numbers, said: Numbers, name: string): boolean {
  const number = name.replace(/^(AU|L|R)(?=\d)/, '');
  const value = said[name]!;
  // A whole that was taken apart into equal sides is told as a whole.
  if (value === 0 && [`L${number}`, `R${number}`].some((side) => side in said)) return true;
  const shown = told[name] ?? (value === 0 ? 0 : (told[`AU${number}`] ?? told[`L${number}`] ?? 0));
  return Math.abs(shown - value) < SAME;
}
