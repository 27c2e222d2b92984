// What the service refuses: with which answer, whether asking again may help, and when.

/** Answers below 500 that pass by themselves: too slow, not just now, too much at once. */
const PASSING: readonly number[] = [408, 409, 429];
const MILLISECONDS = 1000;

/** An answer other than 2xx. `status` is 0 when there was no answer at all. */
export class ApiError extends Error {
  constructor(
    readonly status: number,
    message: string,
    /** When the service wants to be asked again [s]; 0 where it does not say. */
    readonly retryAfter = 0,
  ) {
    super(message);
  }

  /** Whether the same question would be refused again, however often it is asked. */
  get isFinal(): boolean {
    return this.status >= 400 && this.status < 500 && !PASSING.includes(this.status);
  }
}

/** Whether to ask again is in vain. */
export function isFinal(error: unknown): boolean {
  return error instanceof ApiError && error.isFinal;
}

/** The answer that an error stands for; 0 where nobody answered, or nobody was asked. */
export function answerOf(error: unknown): number {
  return error instanceof ApiError ? error.status : 0;
}

/** How long the service wants to be left alone [ms]; 0 where it does not say. */
export function restOf(error: unknown): number {
  return error instanceof ApiError ? error.retryAfter * MILLISECONDS : 0;
}

/** Read a refusal: its sentence, and when to come back. */
export async function refusalOf(response: Response): Promise<ApiError> {
  const answer: unknown = await response.json().catch(() => null);
  const message = (answer as { message?: unknown } | null)?.message;
  const seconds = Number(response.headers.get('Retry-After') ?? 0);
  return new ApiError(
    response.status,
    typeof message === 'string' ? message : `The service answered ${response.status}.`,
    seconds > 0 ? seconds : 0,
  );
}
