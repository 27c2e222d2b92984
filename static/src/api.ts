// REST calls of the viewer, and the addresses it links to.

import { ClipJobs } from './clip-jobs';
import type { FaceState } from './protocol';
import type { AttributeInfo, Recipe } from './recipe';
import type { Place } from './feelings';
import type { MuscleForm } from './muscle-shape';
import { ApiError, refusalOf } from './refusal';
import { withTicket } from './ticket';

/** Anything numeric in here can be edited; see tissueFields. */
export type Tissue = Record<string, unknown>;

export interface MuscleInfo extends MuscleForm {
  activation?: unknown;
  force_scale?: number;
  strength?: number;
}

export interface ActionUnitInfo {
  name: string;
  title?: string;
  region?: string;
  /** Weight of each muscle. */
  muscles?: unknown;
  source?: string;
}

export interface EmotionInfo {
  name: string;
  recipe?: string;
  source?: string;
}

export interface RigInfo {
  id: string;
  name: string;
  muscles: MuscleInfo[];
  action_units: ActionUnitInfo[];
  emotions: EmotionInfo[];
  tissue: Tissue;
  /** What the person looks like; null where the face has no recipe. */
  recipe: Recipe | null;
  mesh: Record<string, unknown>;
  /** Lowest and highest value of each pose axis, e.g. limits.jaw.pitch. */
  limits: Record<string, Record<string, [number, number]>>;
}

export interface People {
  people: { name: string; title: string }[];
  attributes?: Record<string, AttributeInfo>;
}

export interface ReadFacs {
  canonical: string;
  units: { name: string; side: string; intensity: number }[];
  warnings: { message: string }[];
}

export interface SessionInfo extends FaceState {
  id: string;
  rig: string;
  rig_name?: string;
  /** Forms of the physics, such as its integrator. */
  model?: Record<string, unknown>;
  stream?: string;
  surface?: string;
  tick?: number;
  asleep?: boolean;
  viewers?: number;
  /** Seconds since 1970. */
  created?: number;
}

const TICKET_SECONDS = 86_400;

export class Api {
  /** A key of the service, empty where none is asked for; it goes into headers only. */
  key = '';
  /** A ticket for the session that is shown, for what takes no headers. */
  ticket = '';
  readonly clips = new ClipJobs((method, path, body) => this.ask(method, path, body));

  /** @param base address of the page, e.g. `https://host/face/`; the API lies beside it under `api/`. */
  constructor(private readonly base: string) {}

  rig(rig: string): Promise<RigInfo> {
    return this.json('GET', `api/rigs/${encodeURIComponent(rig)}`).then((body) =>
      completeRig(rig, body as RigAnswer),
    );
  }

  /** The people that come with the service, and what can be asked of others. */
  people(): Promise<People> {
    return this.json('GET', 'api/people') as Promise<People>;
  }

  /** Recipes of expressions, with where each lies among feelings. */
  feelings(): Promise<{ recipes: (Partial<Place> & { name: string })[] }> {
    return this.json('GET', 'api/emotions') as ReturnType<Api['feelings']>;
  }

  /** A FACS string as a rig reads it. */
  readFacs(facs: string, rig: string): Promise<ReadFacs> {
    return this.json('POST', 'api/facs', { facs, rig }) as Promise<ReadFacs>;
  }

  /** The rig of a person who looks like this, kept as long as a session is on it. */
  person(base: string, recipe: Recipe): Promise<{ id: string }> {
    return this.json('POST', 'api/rigs', { base, recipe, passing: true }) as Promise<{
      id: string;
    }>;
  }

  /** The same face with tissue of another age. */
  aged(base: string, age: string): Promise<{ id: string }> {
    return this.json('POST', 'api/rigs', { base, tissue_age: age, passing: true }) as Promise<{
      id: string;
    }>;
  }

  /** A person made by chance; the same seed makes the same one. */
  stranger(seed: number): Promise<{ id: string }> {
    return this.json('POST', 'api/rigs', { recipe: { sample: seed }, passing: true }) as Promise<{
      id: string;
    }>;
  }

  /** What the service is at while it starts; empty once it is ready, or if it does not say. */
  starting(): Promise<string> {
    return this.json('GET', 'api/ready').then(
      () => '',
      (error: unknown) => (error instanceof ApiError && error.status === 503 ? error.message : ''),
    );
  }

  /** Open a face at rest, or one that lives by itself. */
  openSession(rig: string, idle: boolean): Promise<SessionInfo> {
    return this.json('POST', 'api/sessions', { rig, idle }) as Promise<SessionInfo>;
  }

  session(id: string): Promise<SessionInfo> {
    return this.json('GET', `api/sessions/${id}`) as Promise<SessionInfo>;
  }

  /** Exchange the key for a ticket of a session; without a key nothing is needed. */
  async takeTicket(id: string): Promise<void> {
    if (this.key !== '') this.ticket = await this.ticketOf(id);
  }

  /** A ticket of another session; empty where nothing is needed. */
  async ticketOf(id: string): Promise<string> {
    if (this.key === '') return '';
    const asked = { role: 'control', seconds: TICKET_SECONDS };
    const issued = await this.json('POST', `api/sessions/${id}/tickets`, asked);
    return (issued as { ticket: string }).ticket;
  }

  /** Where the tissue under the skin of a face is now. */
  async layers(id: string): Promise<ArrayBuffer> {
    const response = await this.ask('GET', `api/sessions/${id}/layers`);
    return response.arrayBuffer();
  }

  /** Keep a rig: what it is made from, and what is changed of that. */
  saveRig(changes: object): Promise<{ id: string }> {
    return this.json('POST', 'api/rigs', changes) as Promise<{ id: string }>;
  }

  /** The page that shows a session to whoever has its address, for a day. */
  async linkTo(id: string, role: 'read' | 'control'): Promise<string> {
    const issued = await this.json('POST', `api/sessions/${id}/tickets`, {
      role,
      seconds: TICKET_SECONDS,
    });
    return (issued as { url: string }).url;
  }

  closeSession(id: string): Promise<unknown> {
    return this.json('DELETE', `api/sessions/${id}`);
  }

  patchTissue(id: string, tissue: Tissue): Promise<{ rig?: string }> {
    return this.json('PATCH', `api/sessions/${id}/tissue`, tissue) as Promise<{ rig?: string }>;
  }

  patchMuscle(id: string, muscle: string, fields: object): Promise<{ rig?: string }> {
    const path = `api/sessions/${id}/muscles/${encodeURIComponent(muscle)}`;
    return this.json('PATCH', path, fields) as Promise<{ rig?: string }>;
  }

  /** Absolute address of a path that the service named, or of one below the page. */
  place(path: string): string {
    const below = path.startsWith('/api/') ? path.slice(1) : path;
    return new URL(below, this.base).href;
  }

  /** The same with the ticket, where the service asks for one. */
  address(path: string): string {
    return withTicket(this.place(path), /^\/?api\//.test(path) ? this.ticket : '');
  }

  streamAddress(id: string): string {
    return this.address(`api/sessions/${id}/stream`).replace(/^http/, 'ws');
  }

  private async json(method: string, path: string, body?: unknown): Promise<unknown> {
    const response = await this.ask(method, path, body);
    return response.json().catch(() => null) as Promise<unknown>;
  }

  /** @throws ApiError for every answer that is not 2xx, and for none. */
  private async ask(method: string, path: string, body?: unknown): Promise<Response> {
    let response: Response;
    const isFile = body instanceof Blob;
    try {
      response = await fetch(this.address(path), {
        method,
        headers: {
          ...(this.key === '' ? {} : { Authorization: `Bearer ${this.key}` }),
          ...(body === undefined || isFile ? {} : { 'Content-Type': 'application/json' }),
        },
        ...(body === undefined ? {} : { body: isFile ? body : JSON.stringify(body) }),
      });
    } catch {
      throw new ApiError(0, 'The service does not answer.');
    }
    if (response.ok) return response;
    throw await refusalOf(response);
  }
}

type AxisLimits = Record<string, [number, number]>;
type RigAnswer = Partial<RigInfo> & Partial<Record<'jaw' | 'gaze' | 'head' | 'tongue', AxisLimits>>;

/** Older and newer services may leave fields out; the panels then show less, and nothing fails. */
function completeRig(asked: string, body: RigAnswer): RigInfo {
  return {
    id: body.id ?? asked,
    name: body.name ?? asked,
    muscles: named<MuscleInfo>(body.muscles),
    action_units: named<ActionUnitInfo>(body.action_units),
    emotions: named<EmotionInfo>(body.emotions),
    tissue: body.tissue ?? {},
    recipe: body.recipe ?? null,
    mesh: body.mesh ?? {},
    limits: {
      jaw: body.jaw ?? {},
      gaze: body.gaze ?? {},
      head: body.head ?? {},
      tongue: body.tongue ?? {},
    },
  };
}

/** A list of named things, also when it comes as a mapping from name to thing. */
function named<T extends { name: string }>(given: unknown): T[] {
  if (Array.isArray(given)) return given as T[];
  if (given === null || typeof given !== 'object') return [];
  return Object.entries(given).map(([name, fields]) => ({ ...(fields as object), name }) as T);
}
