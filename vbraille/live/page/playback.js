/** Playing a recording back: pause, step, speed, and a timeline of what happened in it. */

import { button, byId, clamp, clock, html, svg, write } from "./elements.js";

const SPEEDS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10];
const STEP_S = 0.1;
const INSET_PX = 5; // half of a slider's thumb
const MOST_LISTED = 2000;
const WRONG = "wrong"; // of the choice of kinds

/** A mark for each kind of event: a shape of 10 pixels around 0, 0. */
const SHAPES = {
  line: "M-0.6 -6h1.2v12h-1.2z",
  trial: "M0 -6l5 10h-10z",
  cue: "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0",
  answer: "M0 -5.5l5 5.5l-5 5.5l-5 -5.5z",
  fault: "M-5 -4l1.4 -1.4l3.6 3.6l3.6 -3.6l1.4 1.4l-3.6 3.6l3.6 3.6l-1.4 1.4l-3.6 -3.6l-3.6 3.6l-1.4 -1.4l3.6 -3.6z",
  tuning: "M-4 -4h8v8h-8z",
  pause: "M-3.5 -5h2.4v10h-2.4zM1.1 -5h2.4v10h-2.4z",
  note: "M-4.5 0a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0 -9 0zm1.4 0a3.1 3.1 0 1 1 6.2 0a3.1 3.1 0 1 1 -6.2 0z",
};

const shape = (kind, look = {}) => svg("path", { class: `mark ${kind}`, d: SHAPES[kind] ?? SHAPES.note, ...look });
const icon = (kind) => svg("svg", { viewBox: "-7 -7 14 14", class: "shape", "aria-hidden": "true" }, shape(kind));

export class Playback {
  on = false;
  at_s = 0;
  playing = false;
  wanted = false; // whether a frame is wanted that was not asked for
  #length = 0;
  #tick_s = 0.001;
  #then = NaN;
  #moments = [];
  #listed = [];
  #current = -2;

  constructor(wake) {
    this.wake = wake;
    const select = (id, ...options) => html("select", { id }, ...options.map(([value, words]) => html("option", { value }, words)));
    this.play = button("Play", () => this.#toggle(), { class: "play" });
    this.scrubber = html("input", { type: "range", id: "scrubber", min: 0, step: "any", "aria-label": "Time in the recording" });
    this.marks = svg("svg", { "aria-hidden": "true", class: "timeline", height: 16 });
    this.time = html("output", { class: "time", for: "scrubber" });
    this.speed = select("speed", ...SPEEDS.map((speed) => [speed, `${speed} ×`]));
    this.kinds = select("kinds");
    this.list = html("ol", { class: "moments", tabindex: 0, "aria-label": "Events of the recording" });
    this.legend = html("p", { class: "legend" });
    this.speed.value = "1";
    this.kinds.addEventListener("change", () => this.#draw());
    this.scrubber.addEventListener("input", () => this.go(Number(this.scrubber.value)));
    this.scrubber.addEventListener("keydown", (event) => this.#key(event));
    const step = (label, by, words) => button(label, () => this.#step(by()), { "aria-label": words });
    byId("transport").append(
      html("div", { class: "timebar" }, this.marks, this.scrubber, this.legend),
      html("div", { class: "buttons" }, this.play, this.time,
        step("−0.1 s", () => -STEP_S, "back by 0.1 s"), step("−1 tick", () => -this.#tick_s, "back by one tick"),
        step("+1 tick", () => this.#tick_s, "on by one tick"), step("+0.1 s", () => STEP_S, "on by 0.1 s"),
        html("label", {}, "speed ", this.speed)),
      html("div", { class: "buttons" }, button("Previous event", () => this.#jump(-1)), button("Next event", () => this.#jump(1)),
        html("label", {}, "of ", this.kinds)),
      this.list);
    new ResizeObserver(() => this.#mark()).observe(this.marks);
  }

  /** Begins with a recording, if a page is welcomed to one. */
  begin({ playback, length_s, moments }) {
    this.on = playback;
    byId("playback").hidden = !playback;
    if (!playback) return;
    [this.#length, this.#moments] = [length_s, moments];
    this.scrubber.max = String(length_s);
    const options = [["", "all kinds"], ...[...new Set(moments.map(({ kind }) => kind))].map((kind) => [kind, `${kind}s`])];
    if (moments.some(({ right }) => right === false)) options.push([WRONG, "wrong answers"]);
    this.kinds.replaceChildren(...options.map(([value, words]) => html("option", { value }, words)));
    write(byId("playback-note"), `${clock(length_s)} long, ${moments.length} events`);
    this.#draw();
    this.go(this.at_s);
  }

  tick(rate_hz) {
    if (rate_hz > 0) this.#tick_s = 1 / rate_hz;
  }

  /** Events of the kinds that are chosen. */
  get #chosen() {
    const chosen = this.kinds.value;
    return this.#moments.filter(({ kind, right }) => !chosen || kind === chosen || (chosen === WRONG && right === false));
  }

  #draw() {
    this.#listed = this.#chosen.slice(0, MOST_LISTED).map(({ at_s, kind, text }) => {
      const made = button("", () => this.go(at_s), { "data-at": at_s, class: "moment" });
      made.append(html("span", { class: "time" }, clock(at_s)), icon(kind), html("span", { class: "what" }, kind), html("span", {}, text));
      return made;
    });
    this.list.replaceChildren(...this.#listed.map((made) => html("li", {}, made)));
    this.list.hidden = this.#listed.length === 0;
    this.#current = -2;
    this.#mark();
    this.show();
  }

  /** Draws the timeline and its key. */
  #mark() {
    const width = this.marks.clientWidth - 2 * INSET_PX;
    if (!this.on || width <= 0) return;
    const chosen = this.#chosen;
    this.marks.replaceChildren(...chosen.slice(0, MOST_LISTED).map(({ at_s, kind, right }) => {
      const x = INSET_PX + (at_s / (this.#length || 1)) * width;
      return shape(right === false ? `${kind} wrong` : kind, { transform: `translate(${x.toFixed(1)} 8)` });
    }));
    const kinds = [...new Set(chosen.map(({ kind }) => kind))];
    this.legend.replaceChildren(...kinds.map((kind) => html("span", {}, icon(kind), `${kind}s`)));
  }

  #toggle() {
    this.playing = !this.playing;
    if (this.playing && this.at_s >= this.#length - 1e-9) this.go(0);
    this.#then = NaN;
    this.wanted = true; // where it stops, the numbers are those of the picture
    write(this.play, this.playing ? "Pause" : "Play");
    this.wake();
  }

  /** Goes to a time. */
  go(at_s) {
    this.at_s = clamp(at_s, 0, this.#length);
    this.wanted = true;
    this.show();
    this.wake();
  }

  #step(by_s) {
    if (this.playing) this.#toggle();
    this.go(this.at_s + by_s);
  }

  #jump(way) {
    const edge = this.at_s + way * this.#tick_s * 0.5;
    const ahead = this.#chosen.filter(({ at_s }) => (way > 0 ? at_s > edge : at_s < edge));
    if (ahead.length) this.go(ahead[way > 0 ? 0 : ahead.length - 1].at_s);
  }

  #key(event) {
    const step = event.shiftKey ? 1 : STEP_S;
    const by = { ArrowRight: step, ArrowUp: step, ArrowLeft: -step, ArrowDown: -step, PageUp: 10, PageDown: -10, Home: -Infinity, End: Infinity }[event.key];
    if (!by) return;
    event.preventDefault();
    this.go(this.at_s + by);
  }

  /** Goes on by the time that has passed; the browser's time is in ms. */
  advance(now) {
    if (!this.playing) return;
    const passed_s = Number.isNaN(this.#then) ? 0 : Math.min((now - this.#then) / 1000, 2);
    this.#then = now;
    this.at_s = Math.min(this.at_s + passed_s * Number(this.speed.value), this.#length);
    this.wanted = true;
    if (this.at_s >= this.#length) this.#toggle();
  }

  /** What to ask for now. */
  request() {
    this.wanted = false;
    return { at_s: this.at_s };
  }

  /** Shows where the recording is. */
  show() {
    const words = `${clock(this.at_s)} of ${clock(this.#length)}`;
    write(this.time, words);
    this.scrubber.value = String(this.at_s);
    this.scrubber.setAttribute("aria-valuetext", words);
    const current = this.#listed.findLastIndex((made) => Number(made.dataset.at) <= this.at_s + 1e-9);
    if (current === this.#current) return;
    this.#listed[this.#current]?.removeAttribute("aria-current");
    this.#listed[current]?.setAttribute("aria-current", "true");
    this.#current = current;
    const item = this.#listed[current];
    if (item && !this.list.contains(document.activeElement)) {
      this.list.scrollTop = item.offsetTop - this.list.offsetTop - this.list.clientHeight / 2;
    }
  }
}
