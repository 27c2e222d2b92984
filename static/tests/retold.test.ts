// What the panels did, told to others.

import { describe, expect, it } from 'vitest';
import { controlsCommand, emotionCommand, idleCommand, replaceCommand } from '../src/protocol';
import { callOf, curlOf, pythonOf } from '../src/retold';

const ADDRESS = 'http://127.0.0.1:8000/api/sessions/abc';

describe('callOf', () => {
  it('says over HTTP what was said over the socket', () => {
    expect(callOf(controlsCommand({ action_units: { AU12: 0.5 } }))).toEqual({
      method: 'PATCH',
      path: 'controls',
      body: { action_units: { AU12: 0.5 } },
    });
    expect(
      callOf(replaceCommand({ layer: 'puppet', fade: 0.2, action_units: {}, jaw: { pitch: 4 } })),
    ).toEqual({
      method: 'PUT',
      path: 'controls',
      body: { layer: 'puppet', fade: 0.2, jaw: { pitch: 4 } },
    });
    expect(callOf(emotionCommand('fear', 1, null))?.body).toMatchObject({ fade_in: null });
    expect(callOf(idleCommand(true))).toEqual({ method: 'PUT', path: 'idle', body: {} });
    expect(callOf(idleCommand(false))).toEqual({ method: 'DELETE', path: 'idle', body: null });
    expect(callOf('{"type": "ack", "tick": 3}')).toBeNull();
  });
});

describe('a call that is retold', () => {
  const smile = callOf(controlsCommand({ action_units: { AU12: 0.5 } }))!;

  it('is a line for a shell', () => {
    expect(curlOf(smile, ADDRESS, false)).toBe(
      `curl -X PATCH '${ADDRESS}/controls' \\\n  -H 'Content-Type: application/json' \\\n` +
        `  -d '{"action_units":{"AU12":0.5}}'`,
    );
    const still = callOf(idleCommand(false))!;
    expect(curlOf(still, ADDRESS, true)).toBe(
      `curl -X DELETE '${ADDRESS}/idle' \\\n  -H "Authorization: Bearer $RISORIUS_KEY"`,
    );
  });

  it('is Python', () => {
    const fear = callOf(emotionCommand('fear', 1, null))!;
    const program = pythonOf(fear, ADDRESS, true);
    expect(program).toContain('"fade_in": None');
    expect(program).toContain('import json, os, urllib.request');
    expect(program).toContain('method="POST"');
    expect(pythonOf(callOf(idleCommand(false))!, ADDRESS, false)).not.toContain('json');
  });
});
