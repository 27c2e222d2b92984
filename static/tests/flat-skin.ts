// A skin that tests know by heart.

/** Points along a side of it. */
export const WIDE = 9;

/** A flat skin of squares 1 wide, 8 by 8, each of two triangles. */
export function flatSkin(): { positions: number[]; triangles: number[] } {
  const positions: number[] = [];
  const triangles: number[] = [];
  for (let y = 0; y < WIDE; y++) for (let x = 0; x < WIDE; x++) positions.push(x, y, 0);
  for (let y = 0; y + 1 < WIDE; y++) {
    for (let x = 0; x + 1 < WIDE; x++) {
      const at = y * WIDE + x;
      triangles.push(at, at + 1, at + WIDE + 1, at, at + WIDE + 1, at + WIDE);
    }
  }
  return { positions, triangles };
}
