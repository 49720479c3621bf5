/**
 * Traces of the position and of one actuator over five seconds at the device's full rate. The pen
 * goes from left to right and begins anew, as on an oscilloscope: only what is new is drawn.
 */

import { fixed, html, svg } from "./drawing.js";
import { colours, onScheme } from "./palette.js";

/** @typedef {import("./messages.js").Frame} Frame */

export const SPAN_S = 5;
const GAP_S = 0.12; // wiped before the pen
const BREAK_S = 0.25; // without a sample for so long, the line is broken
const DRAW_MS = 60; // the pen goes by a hair's breadth meanwhile
const HIGH_PX = 84;
const LEFT_PX = 58;

/** One trace: a canvas over its axes. */
class Trace {
  #low = 0;
  #high = 1;
  #time = NaN; // of the pen, in seconds
  #value = NaN;
  #up = NaN; // where the pen is on the paper within a stroke
  #paper = "";

  /**
   * @param {HTMLElement} parent
   * @param {string} label
   */
  constructor(parent, label) {
    this.canvas = html("canvas", { role: "img", "aria-label": label });
    this.axes = svg("svg", { "aria-hidden": "true", class: "axes" });
    this.caption = html("figcaption", {}, label);
    this.figure = html("figure", { class: "trace" }, this.caption, html("div", { class: "layers" }, this.axes, this.canvas));
    parent.append(this.figure);
    this.pen = /** @type {CanvasRenderingContext2D} */ (this.canvas.getContext("2d"));
  }

  /**
   * Names what is traced, and sets its scale; the paper is wiped if that changes.
   * @param {string} label
   * @param {number} low
   * @param {number} high
   * @param {number[]} ticks
   * @param {boolean} seconds whether the time stands below it
   */
  set(label, low, high, ticks, seconds) {
    const width = this.figure.clientWidth;
    const paper = JSON.stringify([label, low, high, ticks, width, devicePixelRatio]);
    if (paper === this.#paper || width === 0) return;
    this.#paper = paper;
    [this.#low, this.#high] = [low, high];
    this.caption.textContent = label;
    this.canvas.setAttribute("aria-label", `${label}, over the last ${SPAN_S} seconds`);
    const [wide, high_px] = [width - LEFT_PX, HIGH_PX];
    const below = seconds ? 20 : 4;
    this.axes.setAttribute("width", String(width));
    this.axes.setAttribute("height", String(high_px + below + 6));
    this.canvas.width = Math.round(wide * devicePixelRatio);
    this.canvas.height = Math.round(high_px * devicePixelRatio);
    this.canvas.style.width = `${wide}px`;
    this.canvas.style.height = `${high_px}px`;
    const group = svg("g", { transform: `translate(${LEFT_PX} 6)` });
    for (const tick of ticks) {
      const y = high_px * (1 - (tick - low) / (high - low));
      group.append(svg("path", { class: "grid", d: `M0 ${y}H${wide}` }));
      group.append(svg("text", { x: -8, y: y + 4, "text-anchor": "end" }, String(tick)));
    }
    let path = "";
    for (let second = 0; second <= SPAN_S; second++) {
      const x = (second / SPAN_S) * wide;
      path += `M${x} ${high_px}v-5`;
      if (seconds) {
        const anchor = second === 0 ? "start" : second === SPAN_S ? "end" : "middle";
        group.append(svg("text", { x, y: high_px + 15, "text-anchor": anchor }, second === SPAN_S ? `${second} s` : String(second)));
      }
    }
    group.append(svg("path", { class: "ticks", d: path }));
    this.axes.replaceChildren(group);
    this.wipe();
  }

  /** Begins on clean paper. */
  wipe() {
    this.#time = this.#value = NaN;
    this.pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
  }

  /**
   * Draws samples: what comes after the pen.
   * @param {Frame} frame
   * @param {number} column of the samples, 1 or 2
   */
  draw(frame, column) {
    const { width, height } = this.canvas;
    const newest = frame.time_s;
    if (newest < this.#time - 1e-6 || newest > this.#time + SPAN_S) this.wipe();
    const { samples } = frame;
    const pen = this.pen;
    const sharp = devicePixelRatio;
    pen.strokeStyle = colours().trace;
    pen.lineWidth = 1.4 * sharp;
    pen.lineJoin = "round";
    const across = (/** @type {number} */ time) => (((time % SPAN_S) + SPAN_S) % SPAN_S / SPAN_S) * width;
    const up = (/** @type {number} */ value) =>
      (height - 2 * sharp) * (1 - (value - this.#low) / (this.#high - this.#low)) + sharp;
    const last = samples.length - 3;
    if (last < 0 || !(newest - samples[last] > this.#time || Number.isNaN(this.#time))) return;
    const begin = Number.isNaN(this.#time) ? newest - samples[0] : this.#time;
    this.#clear(across(begin), across(newest - samples[last]), width, height);
    pen.beginPath();
    for (let n = 0; n < samples.length; n += 3) {
      const time = newest - samples[n];
      const value = samples[n + column];
      if (time <= this.#time || !Number.isFinite(value)) continue;
      const [from, to] = [across(this.#time), across(time)];
      if (time - this.#time < BREAK_S && to >= from) {
        if (this.#up !== from) pen.moveTo(from, up(this.#value));
        pen.lineTo(to, up(value));
        this.#up = to;
      } else this.#up = NaN;
      [this.#time, this.#value] = [time, value];
    }
    pen.stroke();
    this.#up = NaN;
  }

  /**
   * Wipes the paper under the pen and before it.
   * @param {number} from
   * @param {number} to
   * @param {number} width
   * @param {number} height
   */
  #clear(from, to, width, height) {
    const gap = (GAP_S / SPAN_S) * width;
    const start = from + devicePixelRatio;
    if (to < from) {
      this.pen.clearRect(start, 0, width, height);
      this.pen.clearRect(0, 0, to + gap, height);
      return;
    }
    this.pen.clearRect(start, 0, to - start + gap, height);
    if (to + gap > width) this.pen.clearRect(0, 0, to + gap - width, height);
  }
}

export class Traces {
  /** @type {Frame[]} */
  #frames = [];
  #drawn = -Infinity;

  /** @param {HTMLElement} parent */
  constructor(parent) {
    this.place = new Trace(parent, "position");
    this.actuator = new Trace(parent, "actuator");
    /** @type {() => void} */
    this.again = () => {};
    new ResizeObserver(() => this.again()).observe(parent);
    onScheme(() => this.wipe());
  }

  /**
   * Sets the scales.
   * @param {import("./messages.js").State} state
   * @param {{row: number, column: number}} chosen
   */
  show(state, chosen) {
    const array = state.array;
    if (!array) return;
    this.again = () => this.show(state, chosen);
    const travel = Math.ceil(array.travel_mm / 10) * 10;
    const half = Math.ceil(travel / 20) * 10;
    this.actuator.figure.hidden = state.blind;
    this.place.set("position along the line, x (mm)", -10, travel, [0, half, travel], state.blind);
    this.actuator.set(
      `deflection of row ${chosen.row + 1}, column ${chosen.column + 1} (0 rest, 1 full swing)`, 0, 1, [0, 0.5, 1], true,
    );
  }

  /**
   * Takes a frame; it is drawn with those after it, a few at a time.
   * @param {Frame} frame
   */
  take(frame) {
    this.#frames.push(frame);
    if (performance.now() - this.#drawn >= DRAW_MS) this.draw();
  }

  /** Draws what was taken. */
  draw() {
    for (const frame of this.#frames) {
      this.place.draw(frame, 1);
      if (!this.actuator.figure.hidden) this.actuator.draw(frame, 2);
    }
    this.#frames = [];
    this.#drawn = performance.now();
  }

  wipe() {
    this.#frames = [];
    this.place.wipe();
    this.actuator.wipe();
  }
}

/**
 * Words for a time, such as "1:02.345".
 * @param {number} seconds
 * @param {number} places
 */
export function clock(seconds, places = 3) {
  const minutes = Math.floor(seconds / 60 + 1e-9);
  const rest = fixed(Math.max(seconds - 60 * minutes, 0), places);
  return `${minutes}:${rest.padStart(places + 3, "0")}`;
}
