/** Where cells and dots stand, in mm, and what is under the finger; as `vbraille.layout` has it. */

/** Dots 1 to 8: the dot column, and the dot row. */
export const DOTS = [[0, 0], [0, 1], [0, 2], [1, 0], [1, 1], [1, 2], [0, 3], [1, 3]];

/** Distances of the braille in mm: from cell to cell (pitch), dot row to dot row, line to line; null without braille. */
export function distances(state) {
  const g = state.geometry;
  if (!("dot_width_mm" in g)) return null;
  return {
    width: g.dot_width_mm,
    spacing: g.dot_spacing_mm,
    pitch: g.dot_spacing_mm + g.cell_gap_mm,
    rows: g.row_spacing_mm,
    line: g.line_pitch_mm,
  };
}

export const dotsOf = (mask) => DOTS.flatMap((_, n) => ((mask >> n) & 1 ? [n + 1] : []));
export const unicode = (cells) => cells.map((mask) => String.fromCodePoint(0x2800 + mask)).join("");
export const degrees = (radians) => Math.round((radians * 180) / Math.PI) || 0;

/** Centre of a dot column of a cell, and of a dot row: the three upper ones stand around the line's middle. */
export const dotX = (d, line, cell, column) => line.start_mm + cell * d.pitch + d.width / 2 + column * d.spacing;
export const dotY = (d, line, row) => line.top_mm + d.line / 2 + (row - 1) * d.rows;

/** Right edge of the last dot column of a line. */
export const endOf = (d, line) => line.start_mm + Math.max(line.cells.length - 1, 0) * d.pitch + d.spacing + d.width;

/** Words for the dots that a row of actuators shows, such as "dots 1 4". */
export function rowWords(shown) {
  const dots = shown ? DOTS.flatMap(([column, row], dot) => (shown[column] === row ? [dot + 1] : [])) : [];
  return dots.length ? `dot${dots.length > 1 ? "s" : ""} ${dots.join(" ")}` : "";
}

/** The line under the hand; null if there is none. */
export function lineUnder(state, frame) {
  const d = distances(state);
  const measured = d && state.array?.height_mm > 0 && Number.isFinite(frame.y_mm);
  const over = (line) => line.top_mm <= frame.y_mm && frame.y_mm < line.top_mm + d.line;
  return state.lines.find((line) => (measured ? over(line) : line.under)) ?? null;
}

/**
 * Where the array stands on the page: one axis measures no y, and there its rows stand upon the dots
 * that they show, as well as that goes.
 */
export function placeOf(state, frame) {
  const { array } = state;
  if (array.height_mm > 0) return { x: frame.x_mm, y: frame.y_mm, theta: array.turns ? frame.theta_rad || 0 : 0 };
  const d = distances(state);
  if (!d) return { x: frame.x_mm, y: 0, theta: 0 };
  const offs = state.rows_shown.flatMap((shown, row) =>
    shown.filter((dots) => dots >= 0).map((dots) => (dots - 1) * d.rows - (row - (array.rows - 1) / 2) * array.row_pitch_mm));
  const off = offs.reduce((sum, value) => sum + value, 0) / (offs.length || 1);
  return { x: frame.x_mm, y: (lineUnder(state, frame)?.top_mm ?? 0) + d.line / 2 + off, theta: 0 };
}

/** What is under the finger: line, cell (-1 beside the cells), dots, and where in the print its piece and word are. */
export function under(state, frame) {
  const d = distances(state);
  const line = lineUnder(state, frame);
  if (!d || !line || !Number.isFinite(frame.x_mm)) return null;
  const at = Math.floor((frame.x_mm - line.start_mm) / d.pitch);
  const cell = at in line.cells ? at : -1;
  const source = line.sources[cell] ?? [0, 0];
  return { line, cell, dots: cell < 0 ? [] : dotsOf(line.cells[cell]), source, word: wordAround(line.text, source), character: line.text.slice(...source) };
}

function wordAround(text, [from, to]) {
  if (text.slice(from, to).trim() === "") return [from, from];
  while (from > 0 && /\S/.test(text[from - 1])) from--;
  while (to < text.length && /\S/.test(text[to])) to++;
  return [from, to];
}

/** Words for where the finger is. */
export function sayWhere(state, frame) {
  if (!frame || !Number.isFinite(frame.x_mm)) return "The place of the array is not known.";
  const words = [`x ${frame.x_mm.toFixed(1)} mm`];
  if (state.array?.height_mm > 0) words.push(`y ${frame.y_mm.toFixed(1)} mm`);
  if (state.array?.turns) words.push(`turned ${degrees(frame.theta_rad)}°`);
  const here = state.blind ? null : under(state, frame);
  if (!here) return words.join(", ");
  if (state.place) words.push(state.place);
  if (here.cell < 0) return [...words, "beside the cells"].join(", ");
  words.push(`cell ${here.cell + 1}`, here.dots.length ? `dots ${here.dots.join(" ")}` : "no dots");
  if (here.character.trim()) words.push(`'${here.character}'`);
  const word = here.line.text.slice(...here.word);
  if (word && word !== here.character) words.push(`in '${word}'`);
  return words.join(", ");
}
