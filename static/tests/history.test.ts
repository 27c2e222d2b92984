// Undoing: gestures, not every step of a slider.

import { describe, expect, it } from 'vitest';
import { History } from '../src/state/history';

describe('History', () => {
  it('goes back and forth by gestures', () => {
    const history = new History<number>();
    history.note('AU12', () => 0, 0);
    history.note('AU12', () => 1, 100); // the same slider, dragged on
    history.note('AU4', () => 2, 200);
    expect(history.undo(3)).toBe(2);
    expect(history.undo(2)).toBe(0);
    expect(history.undo(0)).toBeNull();
    expect([history.canUndo, history.canRedo]).toEqual([false, true]);
    expect(history.redo(0)).toBe(2);
    expect(history.redo(2)).toBe(3);
    expect(history.canRedo).toBe(false);
  });

  it('takes a slider that rested for a new gesture', () => {
    const history = new History<number>();
    history.note('AU12', () => 0, 0);
    history.note('AU12', () => 1, 5000);
    expect(history.undo(2)).toBe(1);
  });

  it('forgets what was left once something else is done', () => {
    const history = new History<number>();
    history.note('AU12', () => 0, 0);
    history.undo(1);
    history.note('AU4', () => 0, 10);
    expect(history.canRedo).toBe(false);
  });

  it('keeps a hundred', () => {
    const history = new History<number>();
    for (let i = 0; i < 150; i++) history.note(`slider ${i}`, () => i);
    let steps = 0;
    while (history.undo(0) !== null) steps++;
    expect(steps).toBe(100);
  });
});
