/**
 * What the server tells this page: the shapes of its messages, and frames out of their bytes.
 * `vbraille/live/messages.py` says what each number means.
 */

const HEADER_BYTES = 80;

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
  const [samples, rows, columns, signals] = [0, 2, 4, 6].map((at) => view.getUint16(at, true));
  const size = rows * columns;
  const end = HEADER_BYTES + 4 * size + 12 * samples;
  if (bytes.byteLength < end + 4 * signals) return null;
  const [flags, state, line, part, late] = [8, 12, 16, 20, 24].map((at) => view.getUint32(at, true));
  const [tick, time_s] = [32, 40].map((at) => view.getFloat64(at, true));
  const [x_mm, y_mm, theta_rad, vx_mm_s, lateness_us, work_us, share, age_ms] =
    [48, 52, 56, 60, 64, 68, 72, 76].map((at) => view.getFloat32(at, true));
  return {
    flags, state, line, part, late, tick, time_s, x_mm, y_mm, theta_rad, vx_mm_s, lateness_us, work_us, share, age_ms,
    rows,
    columns,
    deflections: new Float32Array(bytes, HEADER_BYTES, size),
    samples: new Float32Array(bytes, HEADER_BYTES + 4 * size, 3 * samples),
    signals: new Float32Array(bytes, end, signals),
  };
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
