// Which key asks for what.

import { describe, expect, it } from 'vitest';
import { shortcutOf } from '../src/shortcuts';

const key = (
  name: string,
  held: { ctrlKey?: boolean; shiftKey?: boolean; altKey?: boolean } = {},
) => ({
  key: name,
  ctrlKey: false,
  metaKey: false,
  shiftKey: false,
  altKey: false,
  ...held,
});
const run = (): void => undefined;
const shortcuts = [
  { keys: ['mod+z'], does: 'Undo', run },
  { keys: ['mod+shift+z', 'mod+y'], does: 'Redo', run },
  { keys: ['?'], does: 'List', run },
  { keys: ['r'], does: 'Reset', run },
];
const does = (event: ReturnType<typeof key>): string | undefined =>
  shortcutOf(event, shortcuts)?.does;

describe('shortcutOf', () => {
  it('tells keys that are held apart', () => {
    expect(does(key('z', { ctrlKey: true }))).toBe('Undo');
    expect(does(key('Z', { ctrlKey: true, shiftKey: true }))).toBe('Redo');
    expect(does(key('z'))).toBeUndefined();
    expect(does(key('?', { shiftKey: true }))).toBe('List');
    expect(does(key('R', { shiftKey: true }))).toBe('Reset');
    // Reloading the page is the browser's.
    expect(does(key('r', { ctrlKey: true }))).toBeUndefined();
    expect(does(key('r', { altKey: true }))).toBeUndefined();
  });
});
