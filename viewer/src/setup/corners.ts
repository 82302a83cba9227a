// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

/** Row and column of a taxel. */
export type Place = readonly [row: number, col: number];

/** How the lines that a device sends become those of the array, as array.toml says it. */
export interface WayRound {
  transpose: boolean;
  flip_rows: boolean;
  flip_cols: boolean;
}

export const AS_SENT: WayRound = { transpose: false, flip_rows: false, flip_cols: false };

/** Where a taxel of the array is in what its device sends, by the rules of docs/array-toml.md. */
export function sentPlace(
  [row, col]: Place,
  { rows, cols }: { rows: number; cols: number },
  { transpose, flip_rows, flip_cols }: WayRound,
): Place {
  const turnedRow = flip_rows ? rows - 1 - row : row;
  const turnedCol = flip_cols ? cols - 1 - col : col;
  return transpose ? [turnedCol, turnedRow] : [turnedRow, turnedCol];
}

/** The end of a line that a finger means: it may be a quarter of the line off. */
function endOf(line: number, lines: number): number | undefined {
  const most = Math.floor((lines - 1) / 4);
  if (line <= most) return 0;
  return lines - 1 - line <= most ? lines - 1 : undefined;
}

/** The corner that a touch means; undefined where it is near none. */
export function cornerOf([row, col]: Place, rows: number, cols: number): Place | undefined {
  const cornerRow = endOf(row, rows);
  const cornerCol = endOf(col, cols);
  return cornerRow === undefined || cornerCol === undefined ? undefined : [cornerRow, cornerCol];
}

/**
 * From where the two ends of the array's first row are in what is sent: first that of row 0 and column 0. Undefined where
 * the two are opposite corners, or one.
 */
export function wayRound(first: Place, second: Place): WayRound | undefined {
  const isSameRow = first[0] === second[0];
  const isSameCol = first[1] === second[1];
  if (isSameRow === isSameCol) return undefined;
  const isFar = [first[0] > 0, first[1] > 0] as const;
  return isSameRow
    ? { transpose: false, flip_rows: isFar[0], flip_cols: isFar[1] }
    : { transpose: true, flip_rows: isFar[1], flip_cols: isFar[0] };
}

export function describeWayRound({ transpose, flip_rows, flip_cols }: WayRound): string {
  const words = [
    transpose && "rows and columns are exchanged",
    flip_rows && "the last row comes first",
    flip_cols && "the last column comes first",
  ];
  const known = words.filter((word) => word !== false);
  return known.length === 0 ? "The lines are sent as they are." : `The lines are turned: ${known.join(", ")}.`;
}
