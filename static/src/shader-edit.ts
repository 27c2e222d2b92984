// Edits to three's own shaders, which fail loudly when three has changed.

export interface Program {
  vertexShader: string;
  fragmentShader: string;
  uniforms: Record<string, { value: unknown }>;
}

/** Put text in place of text. @throws Error when three's shader no longer has a line that is replaced here. */
export function replaced(source: string, pairs: readonly (readonly [string, string])[]): string {
  for (const [find, put] of pairs) {
    if (!source.includes(find)) throw new Error(`three's shader has no "${find}" any more.`);
    source = source.replace(find, put);
  }
  return source;
}
