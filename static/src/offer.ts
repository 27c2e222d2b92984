// Gives the visitor what the page made: files, and texts on the clipboard.

/** How long the browser may take to begin with a download before its data are let go [ms]. */
const LET_GO_MS = 60_000;

export function offer(file: Blob, name: string): void {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(file);
  link.download = name;
  link.click();
  setTimeout(() => {
    URL.revokeObjectURL(link.href);
  }, LET_GO_MS);
}

/** Tells whether a text is on the clipboard now; pages without a safe origin have none. */
export async function copied(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return false;
  }
}
