// What is being done before a face can be seen, in words, and how far it is.

export interface Step {
  words: string;
  /** 0 to 1; null where nobody knows. */
  share: number | null;
}

const MEGABYTE = 1e6;

/** The face's file on its way. @param total bytes it has, 0 where the service does not say. */
export function fetching(who: string, loaded: number, total: number): Step {
  const got = (loaded / MEGABYTE).toFixed(1);
  if (total <= 0 || loaded > total) {
    return { words: loaded > 0 ? `Fetching ${who}, ${got} MB` : `Fetching ${who}`, share: null };
  }
  const all = (total / MEGABYTE).toFixed(1);
  return { words: `Fetching ${who}, ${got} of ${all} MB`, share: loaded / total };
}

/** The pictures of skin and eyes, which the service may have to paint first. */
export function painting(done: number, maps: number): Step {
  return { words: `Painting the skin, ${done} of ${maps}`, share: done / maps };
}

/** A service that is not ready says what it is at; anything else is left as it was. */
export function starting(answer: string): Step {
  const doing = answer.replace(/^the service is /, '');
  return { words: `The service is starting: ${doing}`, share: null };
}
