// A rig's baked maps: fetched while the face already shows its vertex colours, then faded in.

import type { Texture } from 'three';
import {
  DataTexture,
  ImageBitmapLoader,
  LinearFilter,
  LinearMipmapLinearFilter,
  NoColorSpace,
  SRGBColorSpace,
  Texture as ImageTexture,
} from 'three';
import { ticketIn, withTicket } from './ticket';

/** What a map holds until its file is there: nothing that shows. */
const BLANK = {
  albedo: [255, 255, 255, 255],
  normal: [128, 128, 255, 255],
  orm: [255, 128, 0, 255],
  wrinkles: [128, 128, 255, 255],
  eye: [255, 255, 255, 255],
} as const;

export type MapName = keyof typeof BLANK;

const NAMES = Object.keys(BLANK) as MapName[];
/** Maps that hold a colour; the others hold numbers. */
const COLOURS: readonly MapName[] = ['albedo', 'eye'];
/** Skin turns away from the camera everywhere on a head: without it the cheeks' sides blur. */
const ANISOTROPY = 8;
/** How long vertex colours take to give way to the maps [ms]. */
const FADE_MS = 600;

/** Get the maps' addresses out of a surface file's extras; they count from the file's own address. */
export function mapAddresses(extras: unknown, surface: string): Partial<Record<MapName, string>> {
  const named = (extras as { textures?: Record<string, unknown> } | null | undefined)?.textures;
  const found: Partial<Record<MapName, string>> = {};
  for (const name of NAMES) {
    const path = named?.[name];
    if (typeof path === 'string')
      found[name] = withTicket(new URL(path, surface).href, ticketIn(surface));
  }
  return found;
}

/** Share of a fade of `FADE_MS` that has passed, eased at both ends. */
export function fadeShare(elapsed: number): number {
  const share = Math.min(1, Math.max(0, elapsed / FADE_MS));
  return share * share * (3 - 2 * share);
}

/** Uniforms of the maps, shared by the materials of one face. */
export class FaceMaps {
  readonly uniforms = Object.fromEntries(
    NAMES.map((name) => [name, { value: blank(BLANK[name]) }]),
  ) as unknown as Record<MapName, { value: Texture }>;
  /** 0 vertex colours, 1 maps. */
  readonly shown = { value: 0 };
  /** All that will come has come and is shown in full. */
  settled = false;
  private begun: number | null = null;
  private disposed = false;

  /**
   * Fetch the maps of a face, and begin to fade to them once the skin's are there.
   * @param onProgress told how many have come or failed, and how many there are.
   * @returns what could not be had, as one sentence; vertex colours stay then. Empty if all is well.
   */
  async load(
    addresses: Partial<Record<MapName, string>>,
    onProgress: (done: number, total: number) => void = () => undefined,
  ): Promise<string> {
    const names = Object.keys(addresses) as MapName[];
    let done = 0;
    if (names.length > 0) onProgress(0, names.length);
    const results = await Promise.allSettled(
      names.map((name) =>
        this.loadMap(name, addresses[name]!).finally(() => {
          onProgress(++done, names.length);
        }),
      ),
    );
    const missing = names.filter((_, i) => results[i]!.status === 'rejected');
    if (addresses.albedo === undefined || missing.includes('albedo')) this.settled = true;
    else this.begun = performance.now();
    return missing.length === 0 ? '' : `These maps of the face are missing: ${missing.join(', ')}.`;
  }

  /** Take the fade further; tells whether it has changed what is drawn. */
  step(now: number, motion: boolean): boolean {
    if (this.begun === null || this.settled) return false;
    this.shown.value = motion ? fadeShare(now - this.begun) : 1;
    this.settled = this.shown.value === 1;
    return true;
  }

  get fading(): boolean {
    return this.begun !== null && !this.settled;
  }

  dispose(): void {
    this.disposed = true;
    for (const { value } of Object.values(this.uniforms)) value.dispose();
  }

  private async loadMap(name: MapName, address: string): Promise<void> {
    const loader = new ImageBitmapLoader();
    // Numbers must not be changed on their way; rows stay in the file's order, as glTF counts them.
    loader.setOptions({ premultiplyAlpha: 'none', colorSpaceConversion: 'none' });
    const image = await loader.loadAsync(address);
    if (this.disposed) return;
    const texture = new ImageTexture(image);
    texture.flipY = false;
    texture.colorSpace = COLOURS.includes(name) ? SRGBColorSpace : NoColorSpace;
    texture.anisotropy = ANISOTROPY;
    texture.minFilter = LinearMipmapLinearFilter;
    texture.magFilter = LinearFilter;
    texture.needsUpdate = true;
    this.uniforms[name].value.dispose();
    this.uniforms[name].value = texture;
  }
}

function blank(texel: readonly number[]): Texture {
  const texture = new DataTexture(new Uint8Array(texel), 1, 1);
  texture.needsUpdate = true;
  return texture;
}
