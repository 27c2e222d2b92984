// What is read of a refusal, and what a visitor of another page reads of it.

import { describe, expect, it } from 'vitest';
import { refusalOf } from '../src/refusal';
import { visitorWords } from '../src/state/visitor';

describe('a refusal', () => {
  it('has the sentence of the service, and when to come back', async () => {
    const body = JSON.stringify({ error: 'at_capacity', message: 'Start more of them.' });
    const headers = { 'Retry-After': '7' };
    const refusal = await refusalOf(new Response(body, { status: 429, headers }));
    expect(refusal).toMatchObject({ message: 'Start more of them.', retryAfter: 7 });
    expect(refusal.isFinal).toBe(false);
  });

  it('has a sentence where nobody gave one', async () => {
    const refusal = await refusalOf(new Response('<html>', { status: 403 }));
    expect(refusal).toMatchObject({ message: 'The service answered 403.', retryAfter: 0 });
    expect(refusal.isFinal).toBe(true);
  });
});

describe('a visitor', () => {
  const words = (status: 'open' | 'waiting' | 'closed', answer: number, locked = ''): string =>
    visitorWords({ status, answer, locked, isRefused: status === 'closed' });

  it('reads nothing while all is well', () => {
    expect(words('open', 0)).toBe('');
  });

  it('reads nothing of a face that rests out of sight', () => {
    const resting = { status: 'closed', answer: 0, locked: '', isRefused: false } as const;
    expect(visitorWords(resting)).toBe('');
  });

  it('is told apart what passes, what is over and what was never there', () => {
    const said = [
      words('waiting', 429),
      words('waiting', 0),
      words('closed', 404),
      words('closed', 422),
    ];
    expect(new Set(said).size).toBe(4);
    expect(words('closed', 401, 'This service asks for a key.')).not.toContain('key');
  });
});
