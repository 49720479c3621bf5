/**
 * The talk with the server: it is begun again when it is lost, later each time, and frames are pulled:
 * none is asked for before the one before is drawn, so that nothing piles up.
 * `vbraille/live/messages.py` and `frames.py` say what each message and number means.
 */

const HEADER_BYTES = 80;
const FIRST_WAIT_MS = 500;
const LONGEST_WAIT_MS = 10_000;
const SLOW_MS = 12; // beside a frame that takes longer, a second one is asked for

/** Reads a frame out of its bytes. */
function readFrame(bytes) {
  const view = new DataView(bytes);
  const [rows, columns, signals] = [0, 2, 4].map((at) => view.getUint16(at, true));
  const [flags, state, line, part, late] = [8, 12, 16, 20, 24].map((at) => view.getUint32(at, true));
  const [tick, time_s] = [32, 40].map((at) => view.getFloat64(at, true));
  const [x_mm, y_mm, theta_rad, vx_mm_s, lateness_us, work_us, share, age_ms] = new Float32Array(bytes, 48, 8);
  const size = rows * columns;
  return {
    rows, columns, flags, state, line, part, late, tick, time_s,
    x_mm, y_mm, theta_rad, vx_mm_s, lateness_us, work_us, share, age_ms,
    deflections: new Float32Array(bytes, HEADER_BYTES, size),
    signals: new Float32Array(bytes, HEADER_BYTES + 4 * size, signals),
  };
}

/** Remarks of a frame: bits of `vbraille.engine.record.Flag`. */
const FLAGS = /** @type {[number, string][]} */ ([
  [1, "paused"],
  [2, "no place from the device"],
  [16, "waits to be told that it is at the left stop"],
  [32, "resting"],
  [256, "the device is at rest by itself"],
  [1024, "rests: the array is turned too far"],
]);

export const sayFlags = (flags) => FLAGS.filter(([bit]) => flags & bit).map(([, words]) => words).join(", ");

export class Connection {
  open = false; // whether the server has said welcome
  #socket = null;
  #wait = FIRST_WAIT_MS;
  #refused = false;
  #asked = []; // when each frame on its way was asked for
  #slow = true;

  /** The listener has `welcomed`, `told`, `framed`, `refused` and `lost`. */
  constructor(token, listener) {
    this.token = token;
    this.listener = listener;
  }

  begin() {
    const socket = (this.#socket = new WebSocket(`ws://${location.host}/live`));
    socket.binaryType = "arraybuffer";
    this.#refused = false;
    socket.addEventListener("open", () => this.#send({ ask: "hello", token: this.token }));
    socket.addEventListener("message", (event) => this.#take(event.data));
    socket.addEventListener("close", () => this.#end());
  }

  ask(request) {
    if (this.open) this.#send(request);
  }

  /** Asks for as many frames as keep the drawing going. */
  pull(wanted, most = this.#slow ? 2 : 1) {
    while (this.open && this.#asked.length < most) {
      this.#asked.push(performance.now());
      this.#send({ ask: "next", ...wanted() });
    }
  }

  #send(request) {
    if (this.#socket?.readyState === WebSocket.OPEN) this.#socket.send(JSON.stringify(request));
  }

  #take(received) {
    if (typeof received !== "string") {
      this.#slow = performance.now() - this.#asked.shift() > SLOW_MS;
      return this.listener.framed(readFrame(received));
    }
    const said = JSON.parse(received);
    if (said.tell === "welcome") {
      [this.open, this.#wait, this.#asked, this.#slow] = [true, FIRST_WAIT_MS, [], true];
      this.listener.welcomed(said);
    } else if (said.tell === "state") {
      this.listener.told(said);
    } else {
      this.#refused = true;
      this.listener.refused(said.why);
    }
  }

  #end() {
    // A page that was not let in is told why, and asks again only when a person wants it.
    const again = this.open || !this.#refused;
    this.open = false;
    this.listener.lost(again);
    if (!again) return;
    setTimeout(() => this.begin(), this.#wait);
    this.#wait = Math.min(2 * this.#wait, LONGEST_WAIT_MS);
  }
}
