// Keys that work wherever no field is being written in.

export interface Shortcut {
  /** As `KeyboardEvent.key` says it; with `mod+` where Ctrl, or Cmd on a Mac, is held. */
  keys: readonly string[];
  /** What it does, for the list of keys. */
  does: string;
  run: () => void;
}

/** Fields that take letters; ranges and buttons do not. */
const WRITTEN_IN = 'input:not([type=range], [type=checkbox]), textarea, select, [contenteditable]';

/** The shortcut that a key asks for, if any. */
export function shortcutOf(
  event: Pick<KeyboardEvent, 'key' | 'ctrlKey' | 'metaKey' | 'shiftKey' | 'altKey'>,
  shortcuts: readonly Shortcut[],
): Shortcut | undefined {
  if (event.altKey) return undefined;
  const mod = event.ctrlKey || event.metaKey;
  const name = (mod ? 'mod+' : '') + (mod && event.shiftKey ? 'shift+' : '');
  const key = name + (event.key.length === 1 ? event.key.toLowerCase() : event.key);
  return shortcuts.find(({ keys }) => keys.includes(key));
}

/** Obey shortcuts from now on, except while somebody writes. */
export function listenForShortcuts(shortcuts: readonly Shortcut[]): void {
  window.addEventListener('keydown', (event) => {
    if (event.defaultPrevented) return;
    if (event.target instanceof Element && event.target.closest(WRITTEN_IN) !== null) return;
    // The space bar is for buttons first.
    if (event.key === ' ' && event.target instanceof HTMLButtonElement) return;
    const found = shortcutOf(event, shortcuts);
    if (found === undefined) return;
    event.preventDefault();
    found.run();
  });
}
