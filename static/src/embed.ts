// <risorius-face>: a live face on somebody else's page, as an element of it.

/** What becomes of the page's address inside, from the attributes of the element. */
const ASKED = ['session', 'ticket', 'rig', 'view', 'light', 'idle', 'dpr'] as const;
const SERVICE = new URL('./', import.meta.url);

class RisoriusFace extends HTMLElement {
  static readonly observedAttributes = [...ASKED, 'emotion', 'intensity'];
  private readonly frame = document.createElement('iframe');
  private ready = false;

  constructor() {
    super();
    const style = document.createElement('style');
    style.textContent = `
      :host { display: inline-block; width: 320px; aspect-ratio: 4 / 5; max-width: 100%; }
      :host([hidden]) { display: none; }
      iframe { display: block; width: 100%; height: 100%; border: 0; background: none; color-scheme: light; }`;
    this.attachShadow({ mode: 'open' }).append(style, this.frame);
  }

  connectedCallback(): void {
    window.addEventListener('message', this.hear);
    this.open();
  }

  disconnectedCallback(): void {
    window.removeEventListener('message', this.hear);
  }

  attributeChangedCallback(name: string, before: string | null, after: string | null): void {
    if (before === after || !this.isConnected) return;
    if (name === 'emotion' || name === 'intensity') this.play();
    else this.open();
  }

  private open(): void {
    const address = new URL(SERVICE);
    address.searchParams.set('embed', '1');
    for (const name of ASKED) {
      const value = this.getAttribute(name);
      if (value !== null) address.searchParams.set(name, value);
    }
    this.frame.title = this.getAttribute('label') ?? 'A simulated face';
    if (this.frame.src === address.href) return;
    this.ready = false;
    this.setAttribute('state', 'opening');
    this.frame.src = address.href;
  }

  private play(): void {
    if (!this.ready) return;
    const label = this.getAttribute('emotion') ?? '';
    const given = this.getAttribute('intensity')?.trim() ?? '';
    const intensity = given === '' ? 1 : Number(given);
    if (!Number.isFinite(intensity)) {
      this.refuse(`intensity is "${given}"; expected a number from 0 to 1`);
      return;
    }
    this.frame.contentWindow?.postMessage(
      { risorius: 'emotion', label, intensity },
      SERVICE.origin,
    );
  }

  /** Tell the page what its face will not do, and the names that it would have understood; it stays as it is. */
  private refuse(words: string, known: unknown = []): void {
    const names = Array.isArray(known) && known.length > 0 ? ` It knows: ${known.join(', ')}.` : '';
    // Who writes the page looks there first.
    // eslint-disable-next-line no-console
    console.warn(`<risorius-face>: ${words.replace(/[.?]?$/, (end) => end || '.')}${names}`);
    this.dispatchEvent(new CustomEvent('refused', { detail: { words, known } }));
  }

  private readonly hear = ({ source, origin, data }: MessageEvent): void => {
    if (source !== this.frame.contentWindow || origin !== SERVICE.origin) return;
    const { risorius, state, session, words, known } = data as Record<string, unknown>;
    if (risorius === 'refused') this.refuse(String(words), known);
    if (risorius !== 'state') return;
    this.setAttribute('state', String(state));
    if (state === 'ready' && !this.ready) {
      this.ready = true;
      if (this.hasAttribute('emotion')) this.play();
    }
    this.dispatchEvent(new CustomEvent('face', { detail: { state, session, words } }));
  };
}

if (!customElements.get('risorius-face')) customElements.define('risorius-face', RisoriusFace);
