// Raw deflate (RFC 1951), undone at once and in one piece: the browser's own only does it later.

/** Base and extra bits of the lengths 257 to 285, and of the distances (section 3.2.5). */
const LENGTH_BASE = [
  3, 4, 5, 6, 7, 8, 9, 10, 11, 13, 15, 17, 19, 23, 27, 31, 35, 43, 51, 59, 67, 83, 99, 115, 131,
  163, 195, 227, 258,
];
const LENGTH_EXTRA = [
  0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0,
];
const DISTANCE_BASE = [
  1, 2, 3, 4, 5, 7, 9, 13, 17, 25, 33, 49, 65, 97, 129, 193, 257, 385, 513, 769, 1025, 1537, 2049,
  3073, 4097, 6145, 8193, 12289, 16385, 24577,
];
const DISTANCE_EXTRA = [
  0, 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7, 8, 8, 9, 9, 10, 10, 11, 11, 12, 12, 13, 13,
];
/** The order in which the lengths of the code of code lengths are sent. */
const ORDER = [16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15];
const END_OF_BLOCK = 256;
const LONGEST_CODE = 15;

export class InflateError extends Error {}

/** Codes up to this length are looked up, longer ones are read bit by bit. */
const QUICK_BITS = 9;

/** A canonical Huffman code: how many codes have each length, and their symbols in order. */
interface Code {
  counts: Uint16Array;
  symbols: Uint16Array;
  /** By the next bits: a symbol times sixteen plus the length of its code; 0 where that is longer. */
  quick: Uint16Array;
}

function codeOf(lengths: Uint8Array): Code {
  const counts = new Uint16Array(LONGEST_CODE + 1);
  for (const length of lengths) counts[length]!++;
  counts[0] = 0;
  const next = new Uint16Array(LONGEST_CODE + 2);
  for (let length = 1; length <= LONGEST_CODE; length++) {
    next[length + 1] = next[length]! + counts[length]!;
  }
  const symbols = new Uint16Array(lengths.length);
  lengths.forEach((length, symbol) => {
    if (length !== 0) symbols[next[length]!++] = symbol;
  });
  return { counts, symbols, quick: quickOf(counts, symbols) };
}

function quickOf(counts: Uint16Array, symbols: Uint16Array): Uint16Array {
  const quick = new Uint16Array(1 << QUICK_BITS);
  let code = 0;
  let index = 0;
  for (let length = 1; length <= QUICK_BITS; length++) {
    for (let n = counts[length]!; n > 0; n--, code++, index++) {
      // The bits of a code come highest first, those of everything else lowest first.
      let reversed = 0;
      for (let bit = 0; bit < length; bit++) reversed |= ((code >> bit) & 1) << (length - 1 - bit);
      for (let at = reversed; at < quick.length; at += 1 << length) {
        quick[at] = (symbols[index]! << 4) | length;
      }
    }
    code <<= 1;
  }
  return quick;
}

const FIXED_LENGTHS = Uint8Array.from({ length: 288 }, (_, symbol) =>
  symbol < 144 ? 8 : symbol < 256 ? 9 : symbol < 280 ? 7 : 8,
);
const FIXED = { literals: codeOf(FIXED_LENGTHS), distances: codeOf(new Uint8Array(30).fill(5)) };

class Bits {
  private at = 0;
  private held = 0;
  private count = 0;

  constructor(private readonly bytes: Uint8Array) {}

  take(count: number): number {
    while (this.count < count) {
      if (this.at >= this.bytes.length) throw new InflateError('The bytes end too early.');
      this.held |= this.bytes[this.at++]! << this.count;
      this.count += 8;
    }
    const value = this.held & ((1 << count) - 1);
    this.held >>>= count;
    this.count -= count;
    return value;
  }

  symbol(code: Code): number {
    while (this.count < QUICK_BITS && this.at < this.bytes.length) {
      this.held |= this.bytes[this.at++]! << this.count;
      this.count += 8;
    }
    const found = code.quick[this.held & ((1 << QUICK_BITS) - 1)]!;
    const length = found & 15;
    if (length === 0 || length > this.count) return this.longSymbol(code);
    this.held >>>= length;
    this.count -= length;
    return found >> 4;
  }

  /** The next symbol, bit by bit: each longer code begins where the shorter ones end. */
  private longSymbol({ counts, symbols }: Code): number {
    let code = 0;
    let first = 0;
    let index = 0;
    for (let length = 1; length <= LONGEST_CODE; length++) {
      code |= this.take(1);
      const count = counts[length]!;
      if (code - count < first) return symbols[index + code - first]!;
      index += count;
      first = (first + count) << 1;
      code <<= 1;
    }
    throw new InflateError('A code is none of those that were announced.');
  }

  /** Bytes that are stored as they are, from the next whole byte on. */
  stored(): Uint8Array {
    this.at -= this.count >> 3;
    this.held = this.count = 0;
    const [low = 0, high = 0] = this.bytes.subarray(this.at, this.at + 2);
    const start = this.at + 4;
    this.at = start + (low | (high << 8));
    if (this.at > this.bytes.length) throw new InflateError('The bytes end too early.');
    return this.bytes.subarray(start, this.at);
  }
}

function readCodes(bits: Bits): { literals: Code; distances: Code } {
  const literals = bits.take(5) + 257;
  const distances = bits.take(5) + 1;
  const lengths = new Uint8Array(literals + distances);
  const ofLengths = new Uint8Array(ORDER.length);
  const sent = bits.take(4) + 4;
  for (let i = 0; i < sent; i++) ofLengths[ORDER[i]!] = bits.take(3);
  const code = codeOf(ofLengths);
  for (let at = 0; at < lengths.length;) {
    const symbol = bits.symbol(code);
    if (symbol < 16) {
      lengths[at++] = symbol;
      continue;
    }
    const repeated = symbol === 16 && at > 0 ? lengths[at - 1]! : 0;
    const times =
      symbol === 16 ? 3 + bits.take(2) : symbol === 17 ? 3 + bits.take(3) : 11 + bits.take(7);
    lengths.fill(repeated, at, at + times);
    at += times;
  }
  return {
    literals: codeOf(lengths.subarray(0, literals)),
    distances: codeOf(lengths.subarray(literals)),
  };
}

/**
 * Undo raw deflate.
 * @param size how many bytes come out.
 * @throws InflateError when it is no such thing, or another number of bytes comes out.
 */
export function inflate(bytes: Uint8Array, size: number): Uint8Array {
  const bits = new Bits(bytes);
  const out = new Uint8Array(size);
  let at = 0;
  let last = false;
  while (!last) {
    last = bits.take(1) === 1;
    const kind = bits.take(2);
    if (kind === 0) {
      const stored = bits.stored();
      if (at + stored.length > size) throw new InflateError(`More than ${size} bytes come out.`);
      out.set(stored, at);
      at += stored.length;
      continue;
    }
    if (kind === 3) throw new InflateError('There is no such kind of block.');
    const { literals, distances } = kind === 1 ? FIXED : readCodes(bits);
    for (;;) {
      const symbol = bits.symbol(literals);
      if (symbol === END_OF_BLOCK) break;
      if (symbol < END_OF_BLOCK) {
        if (at >= size) throw new InflateError(`More than ${size} bytes come out.`);
        out[at++] = symbol;
        continue;
      }
      const length = LENGTH_BASE[symbol - 257]! + bits.take(LENGTH_EXTRA[symbol - 257]!);
      const far = bits.symbol(distances);
      const distance = DISTANCE_BASE[far]! + bits.take(DISTANCE_EXTRA[far]!);
      if (!(distance <= at && at + length <= size)) {
        throw new InflateError(`A repeat reaches out of the ${size} bytes.`);
      }
      for (const end = at + length; at < end; at++) out[at] = out[at - distance]!;
    }
  }
  if (at !== size) throw new InflateError(`${at} bytes come out, not ${size}.`);
  return out;
}
