/** Where cells and dots stand, in mm, and what is under the finger; as `vbraille.layout` has it. */

/** @typedef {import("./messages.js").State} State */
/** @typedef {import("./messages.js").LineShown} LineShown */
/** @typedef {import("./messages.js").Frame} Frame */
/** @typedef {import("./messages.js").ArrayShown} ArrayShown */

/**
 * Distances of the braille in mm.
 * @typedef {object} Distances
 * @property {number} width
 * @property {number} spacing
 * @property {number} pitch from cell to cell
 * @property {number} rows from dot row to dot row
 * @property {number} line from line to line
 */

/**
 * @param {State} state
 * @returns {Distances | null}
 */
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

/** Dots 1 to 8: the dot column, and the dot row. */
export const DOTS = [[0, 0], [0, 1], [0, 2], [1, 0], [1, 1], [1, 2], [0, 3], [1, 3]];

/**
 * The dots of a mask, such as [1, 3].
 * @param {number} mask
 */
export const dotsOf = (mask) => DOTS.flatMap((_, n) => ((mask >> n) & 1 ? [n + 1] : []));

/**
 * Centre of a dot column of a cell.
 * @param {Distances} d
 * @param {LineShown} line
 * @param {number} cell
 * @param {number} column
 */
export const dotX = (d, line, cell, column) =>
  line.start_mm + cell * d.pitch + d.width / 2 + column * d.spacing;

/**
 * Centre of a dot row: the three upper ones stand around the middle of the line.
 * @param {Distances} d
 * @param {LineShown} line
 * @param {number} row
 */
export const dotY = (d, line, row) => line.top_mm + d.line / 2 + (row - 1) * d.rows;

/**
 * Where the line ends: the right edge of its last dot column.
 * @param {Distances} d
 * @param {LineShown} line
 */
export const endOf = (d, line) =>
  line.cells.length === 0
    ? line.start_mm
    : line.start_mm + (line.cells.length - 1) * d.pitch + d.spacing + d.width;

/**
 * The line under the hand.
 * @param {State} state
 * @param {Frame} frame
 * @returns {LineShown | null}
 */
export function lineUnder(state, frame) {
  const d = distances(state);
  if (state.array && d && state.array.height_mm > 0 && Number.isFinite(frame.y_mm)) {
    const over = (/** @type {LineShown} */ line) =>
      line.top_mm <= frame.y_mm && frame.y_mm < line.top_mm + d.line;
    return state.lines.find(over) ?? null;
  }
  return state.lines.find((line) => line.under) ?? null;
}

/**
 * The cell at a place, with the gap after it, as readers are told it; -1 if there is none.
 * @param {Distances} d
 * @param {LineShown} line
 * @param {number} x_mm
 */
export function cellAt(d, line, x_mm) {
  const cell = Math.floor((x_mm - line.start_mm) / d.pitch);
  return cell >= 0 && cell < line.cells.length ? cell : -1;
}

/**
 * Where the array stands on the page: one axis measures no y, and there its rows stand upon the
 * dots that they show.
 * @param {State} state
 * @param {Frame} frame
 */
export function placeOf(state, frame) {
  const array = /** @type {ArrayShown} */ (state.array);
  if (array.height_mm > 0) {
    return { x: frame.x_mm, y: frame.y_mm, theta: array.turns ? frame.theta_rad || 0 : 0 };
  }
  const d = distances(state);
  const line = lineUnder(state, frame);
  const middle = line && d ? line.top_mm + d.line / 2 : d ? d.line / 2 : 0;
  return { x: frame.x_mm, y: middle + (d ? rowsOff(state, d) : 0), theta: 0 };
}

/**
 * How far the middle of the array is from the middle of the line, if its rows stand upon the dots
 * that they show, as well as that goes.
 * @param {State} state
 * @param {Distances} d
 */
function rowsOff(state, d) {
  const array = /** @type {ArrayShown} */ (state.array);
  const off = state.rows_shown.flatMap((shown, row) =>
    shown
      .filter((dots) => dots >= 0)
      .map((dots) => (dots - 1) * d.rows - (row - (array.rows - 1) / 2) * array.row_pitch_mm),
  );
  return off.length ? off.reduce((sum, value) => sum + value, 0) / off.length : 0;
}

/**
 * What is under the finger.
 * @typedef {object} Under
 * @property {LineShown} line
 * @property {number} cell -1 between cells
 * @property {number[]} dots
 * @property {string} character
 * @property {[number, number]} source
 * @property {[number, number]} word where in the line the word begins and ends
 */

/**
 * @param {State} state
 * @param {Frame} frame
 * @returns {Under | null}
 */
export function under(state, frame) {
  const d = distances(state);
  const line = lineUnder(state, frame);
  if (!d || !line || !Number.isFinite(frame.x_mm)) return null;
  const cell = cellAt(d, line, frame.x_mm);
  const source = line.sources[cell] ?? [0, 0];
  return {
    line,
    cell,
    dots: cell < 0 ? [] : dotsOf(line.cells[cell]),
    character: line.text.slice(...source),
    source,
    word: wordAround(line.text, source),
  };
}

/**
 * The word around a piece of a text.
 * @param {string} text
 * @param {[number, number]} piece
 * @returns {[number, number]}
 */
export function wordAround(text, [from, to]) {
  if (to <= from || text.slice(from, to).trim() === "") return [from, from];
  while (from > 0 && /\S/.test(text[from - 1])) from--;
  while (to < text.length && /\S/.test(text[to])) to++;
  return [from, to];
}

/**
 * Words for where the finger is.
 * @param {State} state
 * @param {Frame | null} frame
 */
export function sayWhere(state, frame) {
  if (!frame || !Number.isFinite(frame.x_mm)) return "The place of the array is not known.";
  const words = [`x ${frame.x_mm.toFixed(1)} mm`];
  if (state.array && state.array.height_mm > 0) words.push(`y ${frame.y_mm.toFixed(1)} mm`);
  if (state.array?.turns) words.push(`turned ${degrees(frame.theta_rad)}°`);
  const here = state.blind ? null : under(state, frame);
  if (here === null) return words.join(", ");
  words.push(`line ${here.line.number}`);
  if (here.cell < 0) return [...words, "between cells"].join(", ");
  words.push(`cell ${here.cell + 1}`, here.dots.length ? `dots ${here.dots.join(" ")}` : "no dots");
  if (here.character.trim()) words.push(`'${here.character}'`);
  const word = here.line.text.slice(...here.word);
  if (word && word !== here.character) words.push(`in '${word}'`);
  return words.join(", ");
}

/** @param {number} radians */
export const degrees = (radians) => Math.round((radians * 180) / Math.PI) || 0;

/**
 * Unicode braille of masks.
 * @param {number[]} cells
 */
export const spelled = (cells) => cells.map((mask) => String.fromCodePoint(0x2800 + mask)).join("");
