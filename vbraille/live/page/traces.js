/**
 * The position and one actuator over five seconds, at the device's full rate. The pen goes from left to
 * right and begins anew, as on an oscilloscope: only what is new is drawn.
 */

import { colours, onScheme } from "./colours.js";
import { html, svg } from "./elements.js";

const SPAN_S = 5;
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
  #paper = "";

  constructor(parent) {
    this.canvas = html("canvas", { role: "img" });
    this.axes = svg("svg", { "aria-hidden": "true", class: "axes" });
    this.caption = html("figcaption");
    this.figure = html("figure", { class: "trace" }, this.caption, html("div", { class: "layers" }, this.axes, this.canvas));
    parent.append(this.figure);
    this.pen = this.canvas.getContext("2d");
  }

  /** Names what is traced, and sets its scale; the paper is wiped if that changes. */
  set(label, ticks, low, seconds) {
    const wide = this.figure.clientWidth - LEFT_PX;
    const paper = JSON.stringify([label, ticks, wide, devicePixelRatio]);
    if (paper === this.#paper || wide <= 0) return;
    this.#paper = paper;
    [this.#low, this.#high] = [low, ticks[ticks.length - 1]];
    this.caption.textContent = label;
    this.canvas.setAttribute("aria-label", `${label}, over the last ${SPAN_S} seconds`);
    [this.canvas.width, this.canvas.height] = [wide, HIGH_PX].map((px) => Math.round(px * devicePixelRatio));
    [this.canvas.style.width, this.canvas.style.height] = [`${wide}px`, `${HIGH_PX}px`];
    this.axes.setAttribute("width", wide + LEFT_PX);
    this.axes.setAttribute("height", HIGH_PX + (seconds ? 26 : 10));
    const level = (tick) => HIGH_PX * (1 - (tick - this.#low) / (this.#high - this.#low));
    const times = Array.from({ length: SPAN_S + 1 }, (_, second) => second);
    this.axes.replaceChildren(svg("g", { transform: `translate(${LEFT_PX} 6)` },
      ...ticks.flatMap((tick) => [svg("path", { class: "grid", d: `M0 ${level(tick)}H${wide}` }), svg("text", { x: -8, y: level(tick) + 4, "text-anchor": "end" }, tick)]),
      ...(seconds ? times : []).map((second) => svg("text", {
        x: (second / SPAN_S) * wide, y: HIGH_PX + 15, "text-anchor": second === 0 ? "start" : second === SPAN_S ? "end" : "middle",
      }, second === SPAN_S ? `${second} s` : second)),
      svg("path", { class: "ticks", d: times.map((second) => `M${(second / SPAN_S) * wide} ${HIGH_PX}v-5`).join("") })));
    this.wipe();
  }

  /** Begins on clean paper. */
  wipe() {
    this.#time = this.#value = NaN;
    this.pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
  }

  /** Draws the samples that come after the pen; the column of the samples is 1 or 2. */
  draw({ time_s, samples }, column) {
    if (time_s < this.#time - 1e-6 || time_s > this.#time + SPAN_S) this.wipe();
    const { pen } = this;
    const { width, height } = this.canvas;
    const sharp = devicePixelRatio;
    const across = (time) => (((time % SPAN_S) + SPAN_S) % SPAN_S / SPAN_S) * width;
    const up = (value) => (height - 2 * sharp) * (1 - (value - this.#low) / (this.#high - this.#low)) + sharp;
    const newest = time_s - samples[samples.length - 3];
    if (!(newest > this.#time || (Number.isNaN(this.#time) && samples.length))) return;
    this.#clear(across(Number.isNaN(this.#time) ? time_s - samples[0] : this.#time), across(newest));
    pen.strokeStyle = colours().trace;
    pen.lineWidth = 1.4 * sharp;
    pen.lineJoin = "round";
    pen.beginPath();
    let at = NaN; // where the pen is on the paper within this stroke
    for (let n = 0; n < samples.length; n += 3) {
      const [time, value] = [time_s - samples[n], samples[n + column]];
      if (time <= this.#time || !Number.isFinite(value)) continue;
      const [from, to] = [across(this.#time), across(time)];
      if (time - this.#time < BREAK_S && to >= from) {
        if (at !== from) pen.moveTo(from, up(this.#value));
        pen.lineTo(to, up(value));
        at = to;
      }
      [this.#time, this.#value] = [time, value];
    }
    pen.stroke();
  }

  /** Wipes the paper under the pen and before it. */
  #clear(from, to) {
    const { width, height } = this.canvas;
    const start = from + devicePixelRatio;
    const end = to + (GAP_S / SPAN_S) * width;
    if (to < from || end > width) this.pen.clearRect(0, 0, to < from ? end : end - width, height);
    this.pen.clearRect(start, 0, (to < from ? width : end) - start, height);
  }
}

export class Traces {
  #frames = [];
  #drawn = -Infinity;
  #again = () => {};

  constructor(parent) {
    this.place = new Trace(parent);
    this.actuator = new Trace(parent);
    new ResizeObserver(() => this.#again()).observe(parent);
    onScheme(() => this.wipe());
  }

  /** Sets the scales. */
  show(state, { row, column }) {
    if (!state.array) return;
    this.#again = () => this.show(state, { row, column });
    const travel = Math.ceil(state.array.travel_mm / 10) * 10;
    this.actuator.figure.hidden = state.blind;
    this.place.set("position along the line, x (mm)", [0, Math.ceil(travel / 20) * 10, travel], -10, state.blind);
    this.actuator.set(`deflection of row ${row + 1}, column ${column + 1} (0 rest, 1 full swing)`, [0, 0.5, 1], 0, true);
  }

  /** Takes a frame; it is drawn with those after it, a few at a time. */
  take(frame) {
    this.#frames.push(frame);
    if (performance.now() - this.#drawn >= DRAW_MS) this.draw();
  }

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
