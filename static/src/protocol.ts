// The wire in words: the server's text messages read, commands written. Mirrors service/protocol.py.

export const SUBPROTOCOL = 'risorius.v1';

/** Layers of a face's timeline, from the one that yields first to the one that wins. */
export const LAYERS = ['idle', 'mood', 'emotion', 'speech', 'puppet'] as const;
export type Layer = (typeof LAYERS)[number];

export type Numbers = Record<string, number>;

/** What plays as an emotion: a label, or the mixture of scores or coordinates. */
export interface Played {
  /** Null for a mixture. */
  label: string | null;
  intensity: number;
  vocabulary?: string | null;
  found?: string;
  /** FACS at intensity 1. */
  recipe?: string;
  parts?: { recipe: string; weight: number; variant: number }[];
}

/** What somebody holds of a face. */
export interface Held {
  action_units?: Numbers;
  muscles?: Numbers;
  jaw?: Numbers;
  gaze?: Numbers;
  head?: Numbers;
  tongue?: Numbers;
  /** How much of what lies beneath is overridden, 0 to 1. */
  weight?: number;
  emotion?: Played;
}

/** What one owner holds in a layer. */
export interface Writer extends Held {
  owner: string;
  /** Tick since which it has held anything. */
  since: number;
  /** Seconds that are left of its lease; null if it stays. */
  expires_in: number | null;
}

/** What a layer comes to, and of whom: the one that came to the top last is at the end. */
export interface HeldLayer extends Held {
  writers?: Writer[];
}

/** What all layers come to together. */
export interface Merged extends Held {
  /** The action units as a FACS string. */
  facs?: string;
  /** How its letters are to be read. */
  scale?: 'linear' | 'banded';
  /** For each thing that is held the layers that hold it, lowest first. */
  writers?: Record<string, Layer[]>;
  /** The same with whose it is there. */
  owners?: Record<string, { layer: Layer; owner: string }[]>;
}

export interface FaceState {
  layers?: Partial<Record<Layer, HeldLayer>>;
  merged?: Merged;
  /** What the face does by itself; null for nothing. */
  idle?: Numbers | null;
}

/** The one expression that plays, by the name that a rig's emotion has too; empty for a mixture. */
export function expressionOf(played: Played | undefined): string {
  const [only, ...more] = played?.parts ?? [];
  return only !== undefined && more.length === 0 ? only.recipe : (played?.label ?? '');
}

export interface Hello {
  type: 'hello' | 'rig';
  protocol?: string;
  session: string;
  rig: string;
  surface: string;
  vertices: number;
  rate: number;
  /** Grid step of the displacements [m]. */
  grid: number;
  tick: number;
  state?: FaceState;
  /** `read` where nobody listens to commands. */
  role?: 'read' | 'control';
}

export interface StateMessage extends FaceState {
  type: 'state';
  state?: FaceState;
}

export interface ErrorMessage {
  type: 'error';
  error: string;
  message: string;
  /** Names that would have been accepted. */
  known?: string[];
}

/** A command was obeyed, but not in every point. */
export interface WarningMessage {
  type: 'warning';
  message: string;
}

export interface OtherMessage {
  type: 'other';
}

export type ServerMessage = Hello | StateMessage | ErrorMessage | WarningMessage | OtherMessage;

/** Read a text frame; a type that this viewer does not know becomes `other`, and is left alone. */
export function readMessage(text: string): ServerMessage {
  const message = JSON.parse(text) as { type?: string };
  switch (message.type) {
    case 'hello':
    case 'rig':
    case 'state':
    case 'error':
    case 'warning':
      return message as ServerMessage;
    default:
      return { type: 'other' };
  }
}

/** What one command may move; a layer keeps everything that is not named. */
export interface Controls {
  layer?: Layer;
  fade?: number;
  /** Action units as a FACS string. */
  facs?: string;
  action_units?: Numbers;
  muscles?: Numbers;
  jaw?: Numbers;
  gaze?: Numbers;
  head?: Numbers;
  tongue?: Numbers;
}

/** Move what is named, as PATCH does. */
export function controlsCommand(controls: Controls): string {
  return JSON.stringify({ type: 'controls', ...controls });
}

/** Let a layer hold this and nothing else, as PUT does; without any values it lets go of everything. */
export function replaceCommand(controls: Controls): string {
  return JSON.stringify({ type: 'controls', replace: true, ...controls });
}

/** Play an emotion in its first variant: the same one while its intensity is dragged. */
export function emotionCommand(label: string, intensity: number, fadeIn: number | null): string {
  return JSON.stringify({ type: 'emotion', label, intensity, fade_in: fadeIn, seed: 0 });
}

/** Play the face of a point among feelings. @param fadeIn seconds until it is there. */
export function feelingCommand(
  point: { valence: number; arousal: number; dominance: number },
  fadeIn: number,
): string {
  return JSON.stringify({ type: 'emotion', ...point, fade_in: fadeIn, seed: 0 });
}

/** Have the face live by itself, or no more. */
export function idleCommand(on: boolean): string {
  return JSON.stringify({ type: 'idle', on });
}

export function ackCommand(tick: number): string {
  return JSON.stringify({ type: 'ack', tick });
}
