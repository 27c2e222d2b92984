// A bright page or a dark one: what was chosen on this device, else what the device itself prefers.

export const THEMES = ['auto', 'dark', 'light'] as const;
export type Theme = (typeof THEMES)[number];

const PLACE = 'risorius.theme';

/** What was chosen before; `auto` if nothing was. */
export function keptTheme(): Theme {
  const kept = window.localStorage.getItem(PLACE);
  return THEMES.find((theme) => theme === kept) ?? 'auto';
}

/** Show the page in a theme and remember that; tells which of the two it is. */
export function useTheme(theme: Theme): 'dark' | 'light' {
  const root = document.documentElement;
  if (theme === 'auto') {
    window.localStorage.removeItem(PLACE);
    delete root.dataset.theme;
  } else {
    window.localStorage.setItem(PLACE, theme);
    root.dataset.theme = theme;
  }
  return shown(theme);
}

/** Be told when the device changes its mind, as at sunset. */
export function onDeviceTheme(told: () => void): void {
  bright().addEventListener('change', told);
}

function shown(theme: Theme): 'dark' | 'light' {
  if (theme !== 'auto') return theme;
  return bright().matches ? 'light' : 'dark';
}

function bright(): MediaQueryList {
  return window.matchMedia('(prefers-color-scheme: light)');
}
