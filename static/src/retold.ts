// What the panels did, as a call that anybody can make: for a shell, and for Python.

/** A call of the API for one session. */
export interface Call {
  method: 'PATCH' | 'PUT' | 'POST' | 'DELETE';
  /** Below the session's own address, e.g. `controls`. */
  path: string;
  body: Record<string, unknown> | null;
}

/** The call that does what a text frame of the socket does; null for frames that do nothing. */
export function callOf(frame: string): Call | null {
  const { type, replace, ...rest } = JSON.parse(frame) as {
    type: string;
    replace?: boolean;
    on?: boolean;
  };
  const body = withoutEmpty(rest);
  switch (type) {
    case 'controls':
      return { method: replace === true ? 'PUT' : 'PATCH', path: 'controls', body };
    case 'emotion':
      return { method: 'POST', path: 'emotions', body };
    case 'idle':
      return rest.on === false
        ? { method: 'DELETE', path: 'idle', body: null }
        : { method: 'PUT', path: 'idle', body: {} };
    default:
      return null;
  }
}

/** A line for a shell. @param keyed whether the service asks for a key. */
export function curlOf({ method, path, body }: Call, address: string, keyed: boolean): string {
  return [
    `curl -X ${method} '${address}/${path}'`,
    ...(keyed ? [`-H "Authorization: Bearer $RISORIUS_KEY"`] : []),
    ...(body === null
      ? []
      : ["-H 'Content-Type: application/json'", `-d '${JSON.stringify(body)}'`]),
  ].join(' \\\n  ');
}

/** Lines of Python that need nothing but Python. */
export function pythonOf({ method, path, body }: Call, address: string, keyed: boolean): string {
  const headers = [
    ...(body === null ? [] : ['"Content-Type": "application/json"']),
    ...(keyed ? ['"Authorization": "Bearer " + os.environ["RISORIUS_KEY"]'] : []),
  ];
  return [
    `import ${[...(body === null ? [] : ['json']), ...(keyed ? ['os'] : []), 'urllib.request'].join(', ')}`,
    '',
    ...(body === null ? [] : [`body = ${literal(body)}`]),
    'urllib.request.urlopen(urllib.request.Request(',
    `    "${address}/${path}",`,
    ...(body === null ? [] : ['    data=json.dumps(body).encode(),']),
    ...(headers.length === 0 ? [] : [`    headers={${headers.join(', ')}},`]),
    `    method="${method}",`,
    '))',
  ].join('\n');
}

/** JSON, but for the three words that Python writes otherwise. */
function literal(value: unknown): string {
  if (value === null) return 'None';
  if (value === true) return 'True';
  if (value === false) return 'False';
  if (Array.isArray(value)) return `[${value.map(literal).join(', ')}]`;
  if (typeof value === 'object') {
    const fields = Object.entries(value).map(([name, field]) => `"${name}": ${literal(field)}`);
    return `{${fields.join(', ')}}`;
  }
  return JSON.stringify(value);
}

function withoutEmpty(fields: Record<string, unknown>): Record<string, unknown> {
  return Object.fromEntries(
    Object.entries(fields).filter(
      ([, value]) => typeof value !== 'object' || value === null || Object.keys(value).length > 0,
    ),
  );
}
