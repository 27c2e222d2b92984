// Has the service render clips and read trackers' files, tells how far it is, and cancels what nobody waits for.

export interface ClipInfo {
  id: string;
  status: 'queued' | 'running' | 'done' | 'failed' | 'cancelled';
  progress?: number;
  message?: string;
  report?: { track?: TrackReport };
}

/** What the service says of a tracker's file; see docs/trackers.md. */
export interface TrackReport {
  tracker: string;
  rows: number;
  used: number;
  duration: number;
  rate: number;
  left_out?: number;
  notes: string[];
}

/** Who waits for a job. */
export interface Waiting {
  /** Told how far it is, 0 to 1. */
  onProgress: (share: number) => void;
  cancelled: AbortSignal;
}

/** Send a request: a body that is a file goes as it is, any other as JSON. */
type Ask = (method: string, path: string, body?: unknown) => Promise<Response>;

/** What a job ends with that was cancelled: nothing went wrong. */
export class Cancelled extends Error {}

/** A tracker's file is simulated only for its curves: in the smallest form that there is. */
const READING = 'fps=30&level=low&textures=false';

export class ClipJobs {
  constructor(private readonly ask: Ask) {}

  /** Have a clip rendered. @returns its GLB file. */
  async render(clip: object, waiting: Waiting): Promise<Blob> {
    const { id } = await this.done(await this.post('api/clips', clip), waiting);
    return (await this.ask('GET', `api/clips/${id}.glb`)).blob();
  }

  /**
   * Have a tracker's file played by a rig.
   * @returns a table of what its face does in each frame, and how well the file could be read.
   */
  async read(
    file: Blob,
    rig: string,
    waiting: Waiting,
  ): Promise<{ table: string; report: TrackReport | undefined }> {
    const path = `api/clips?${READING}&rig=${encodeURIComponent(rig)}`;
    const done = await this.done(await this.post(path, file), waiting);
    const table = await (await this.ask('GET', `api/clips/${done.id}.csv`)).text();
    await this.ask('DELETE', `api/clips/${done.id}`);
    return { table, report: done.report?.track };
  }

  private async post(path: string, body: unknown): Promise<ClipInfo> {
    return (await this.ask('POST', path, body)).json() as Promise<ClipInfo>;
  }

  private async done(asked: ClipInfo, { onProgress, cancelled }: Waiting): Promise<ClipInfo> {
    let clip = asked;
    while (clip.status === 'queued' || clip.status === 'running') {
      if (cancelled.aborted) {
        await this.ask('DELETE', `api/clips/${clip.id}`);
        throw new Cancelled('Cancelled.');
      }
      onProgress(clip.progress ?? 0);
      const answer = await this.ask('GET', `api/clips/${clip.id}?wait=1`);
      clip = (await answer.json()) as ClipInfo;
    }
    if (clip.status === 'done') return clip;
    throw new Error(`The clip is not rendered: ${clip.message ?? clip.status}.`);
  }
}
