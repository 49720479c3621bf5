/**
 * What the server tells this page: the shapes of its messages, and frames out of their bytes.
 * `vbraille/live/messages.py` says what each number means.
 */

export const VERSION = 1;
export const FRAME_KIND = 1;
export const MAP_KIND = 2;
const HEADER_BYTES = 80;
const MAP_BYTES = 8;

/**
 * @typedef {object} ArrayShown
 * @property {string} name
 * @property {number} rows
 * @property {number} columns
 * @property {number} column_pitch_mm
 * @property {number} row_pitch_mm
 * @property {number} swing_mm
 * @property {boolean} rest_right
 * @property {number} travel_mm
 * @property {number} height_mm
 * @property {boolean} turns
 * @property {number} rate_hz
 *
 * @typedef {object} LineShown
 * @property {number} number
 * @property {string} text
 * @property {number} start_mm
 * @property {number} top_mm
 * @property {number[]} cells
 * @property {[number, number][]} sources
 * @property {boolean} under
 *
 * @typedef {object} SceneShown
 * @property {string} title
 * @property {string} description
 * @property {number} width_mm
 * @property {number} height_mm
 * @property {string} image
 * @property {number} left_mm
 * @property {number} top_mm
 * @property {string[]} off
 * @property {string} off_image
 *
 * @typedef {object} BesideShown
 * @property {string} mapping
 * @property {[number, number][]} rows_shown
 * @property {number} first_mm
 * @property {number} step_mm
 * @property {string[]} rows
 *
 * @typedef {object} CardShown
 * @property {string} place
 * @property {string} side
 * @property {boolean} felt
 *
 * @typedef {object} KnobShown
 * @property {string} name
 * @property {string} label
 * @property {string} unit
 * @property {number} value
 * @property {number} step
 * @property {number} low
 * @property {number} high
 * @property {string} fixed
 *
 * @typedef {object} Moment
 * @property {number} at_s
 * @property {string} kind
 * @property {string} text
 * @property {boolean | null} [right]
 * @property {string} [condition]
 *
 * @typedef {object} Welcome
 * @property {"welcome"} tell
 * @property {number} version
 * @property {boolean} steers
 * @property {boolean} playback
 * @property {number} length_s
 * @property {Moment[]} moments
 *
 * @typedef {object} State
 * @property {"state"} tell
 * @property {number} number
 * @property {string} title
 * @property {ArrayShown | null} array
 * @property {Record<string, number>} geometry
 * @property {[number, number][]} rows_shown
 * @property {LineShown[]} lines
 * @property {string} place
 * @property {KnobShown[]} knobs
 * @property {string} mapping
 * @property {boolean} paused
 * @property {boolean} simulated
 * @property {boolean} held
 * @property {string} device
 * @property {string[]} said
 * @property {number} said_before
 * @property {[string, string][]} facts
 * @property {boolean} blind
 * @property {boolean} done
 * @property {SceneShown | null} [scene]
 * @property {BesideShown | null} [beside]
 * @property {SceneShown[]} figures
 * @property {{name: string, words: string}[]} signals
 * @property {{name: string, words: string}[]} commands
 * @property {CardShown[][]} cards
 *
 * @typedef {object} Refused
 * @property {"refused"} tell
 * @property {string} why
 *
 * @typedef {object} Frame
 * @property {number} flags
 * @property {number} state
 * @property {number} line
 * @property {number} part
 * @property {number} late
 * @property {number} tick
 * @property {number} time_s
 * @property {number} x_mm
 * @property {number} y_mm
 * @property {number} theta_rad
 * @property {number} vx_mm_s
 * @property {number} lateness_us
 * @property {number} work_us
 * @property {number} share
 * @property {number} age_ms
 * @property {number} rows
 * @property {number} columns
 * @property {Float32Array} deflections
 * @property {Float32Array} samples
 * @property {Float32Array} signals
 */

/**
 * A frame out of its bytes; null if they are none.
 * @param {ArrayBuffer} bytes
 * @returns {Frame | null}
 */
export function readFrame(bytes) {
  if (bytes.byteLength < HEADER_BYTES) return null;
  const view = new DataView(bytes);
  if (view.getUint8(0) !== FRAME_KIND || view.getUint8(1) !== VERSION) return null;
  const samples = view.getUint16(2, true);
  const rows = view.getUint16(72, true);
  const columns = view.getUint16(74, true);
  const size = rows * columns;
  const signals = view.getUint32(76, true);
  const end = HEADER_BYTES + 4 * size + 12 * samples;
  if (bytes.byteLength < end + 4 * signals) return null;
  const u4 = (/** @type {number} */ at) => view.getUint32(at, true);
  const f4 = (/** @type {number} */ at) => view.getFloat32(at, true);
  return {
    flags: u4(4),
    state: u4(8),
    line: u4(12),
    part: u4(16),
    late: u4(20),
    tick: view.getFloat64(24, true),
    time_s: view.getFloat64(32, true),
    x_mm: f4(40),
    y_mm: f4(44),
    theta_rad: f4(48),
    vx_mm_s: f4(52),
    lateness_us: f4(56),
    work_us: f4(60),
    share: f4(64),
    age_ms: f4(68),
    rows,
    columns,
    deflections: new Float32Array(bytes, HEADER_BYTES, size),
    samples: new Float32Array(bytes, HEADER_BYTES + 4 * size, 3 * samples),
    signals: new Float32Array(bytes, end, signals),
  };
}

/**
 * A map out of its bytes; null if they are none.
 * @param {ArrayBuffer} bytes
 * @returns {{svg: boolean, file: Blob} | null}
 */
export function readMap(bytes) {
  if (bytes.byteLength < MAP_BYTES) return null;
  const view = new DataView(bytes);
  if (view.getUint8(0) !== MAP_KIND) return null;
  const svg = view.getUint8(1) !== 0;
  const length = view.getUint32(4, true);
  const type = svg ? "image/svg+xml" : "image/png";
  return { svg, file: new Blob([bytes.slice(MAP_BYTES, MAP_BYTES + length)], { type }) };
}

/** Bits of the flags of a frame that the user should be told: `vbraille.engine.record.Flag`. */
const FLAGS = /** @type {[number, string][]} */ ([
  [1, "paused"],
  [2, "no place from the device"],
  [8, "waits for its mark"],
  [16, "waits to be told that it is at the left stop"],
  [32, "resting"],
  [256, "the device is at rest by itself"],
  [512, "rests: it has moved by itself for as long as it may"],
  [1024, "rests: the array is turned too far"],
]);

/**
 * Words for the flags of a frame.
 * @param {number} flags
 */
export function sayFlags(flags) {
  return FLAGS.filter(([bit]) => flags & bit).map(([, words]) => words).join(", ");
}
