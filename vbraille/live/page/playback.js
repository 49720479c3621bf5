/** Playing a recording back: pause, step, speed, and a timeline of what happened in it. */

import { button, byId, html, svg, write } from "./drawing.js";
import { colours, onScheme } from "./palette.js";
import { clock } from "./traces.js";

/** @typedef {import("./messages.js").Moment} Moment */

const SPEEDS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10];
const STEP_S = 0.1;
const INSET_PX = 5; // half of a slider's thumb
const MOST_LISTED = 2000;
const LEAST_SHOWN_S = 1; // of the timeline, however far it is zoomed

/** A mark for each kind of moment: a shape around (x, 0), 10 pixels high. */
const SHAPES = /** @type {Record<string, (x: number) => string>} */ ({
  line: (x) => `M${x - 0.6} -6h1.2v12h-1.2z`,
  trial: (x) => `M${x} -6l5 10h-10z`,
  cue: (x) => `M${x - 4} 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0`,
  answer: (x) => `M${x} -5.5l5 5.5l-5 5.5l-5 -5.5z`,
  fault: (x) => `M${x - 5} -4l1.4 -1.4l3.6 3.6l3.6 -3.6l1.4 1.4l-3.6 3.6l3.6 3.6l-1.4 1.4l-3.6 -3.6l-3.6 3.6l-1.4 -1.4l3.6 -3.6z`,
  tuning: (x) => `M${x - 4} -4h8v8h-8z`,
  pause: (x) => `M${x - 3.5} -5h2.4v10h-2.4zM${x + 1.1} -5h2.4v10h-2.4z`,
  note: (x) => `M${x - 4.5} 0a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0 -9 0zm1.4 0a3.1 3.1 0 1 1 6.2 0a3.1 3.1 0 1 1 -6.2 0z`,
});
const NAMES = /** @type {Record<string, string>} */ ({
  line: "lines", trial: "trials", cue: "cues", answer: "answers", fault: "faults", tuning: "tunings",
  pause: "pauses", note: "notes",
});

const WRONG = "wrong"; // of the choice of kinds

export class Playback {
  at_s = 0;
  playing = false;
  /** Whether a frame is wanted that was not asked for. */
  wanted = false;
  on = false;
  #since = /** @type {number | null} */ (null);
  #length = 0;
  #from = 0; // what the timeline shows
  #span = 0;
  #tick_s = 0.001;
  #speed = 1;
  #then = NaN;
  /** @type {Moment[]} */
  #moments = [];
  /** @type {HTMLButtonElement[]} */
  #listed = [];
  #current = -2;

  /** @param {() => void} wake */
  constructor(wake) {
    this.wake = wake;
    this.play = button("Play", () => this.#toggle(), { class: "play" });
    this.scrubber = html("input", { type: "range", id: "scrubber", min: 0, step: "any", "aria-label": "Time in the recording" });
    this.marks = svg("svg", { "aria-hidden": "true", class: "timeline", height: 16 });
    this.time = html("output", { class: "time", for: "scrubber" });
    this.speed = html("select", { id: "speed" },
      ...SPEEDS.map((speed) => html("option", { value: speed }, `${speed} ×`)));
    this.kinds = html("select", { id: "kinds" });
    this.paint = html("select", { id: "paint" },
      html("option", { value: "" }, "kind"), html("option", { value: "condition" }, "condition"));
    this.painted = html("label", {}, "colour by ", this.paint);
    this.paint.addEventListener("change", () => this.#mark());
    onScheme(() => this.#mark());
    this.list = html("ol", { class: "moments", tabindex: 0, "aria-label": "Events of the recording" });
    this.legend = html("p", { class: "legend" });
    this.speed.value = "1";
    this.speed.addEventListener("change", () => (this.#speed = Number(this.speed.value)));
    this.kinds.addEventListener("change", () => this.#draw());
    this.scrubber.addEventListener("input", () => this.go(Number(this.scrubber.value)));
    this.scrubber.addEventListener("keydown", (event) => this.#key(event));
    byId("transport").append(
      html("div", { class: "timebar" }, this.marks, this.scrubber, this.legend),
      html("div", { class: "buttons" },
        this.play, this.time,
        button("−0.1 s", () => this.#step(-STEP_S), { "aria-label": "back by 0.1 s" }),
        button("−1 tick", () => this.#step(-this.#tick_s), { "aria-label": "back by one tick" }),
        button("+1 tick", () => this.#step(this.#tick_s), { "aria-label": "on by one tick" }),
        button("+0.1 s", () => this.#step(STEP_S), { "aria-label": "on by 0.1 s" }),
        html("label", {}, "speed ", this.speed)),
      html("div", { class: "buttons" },
        button("Previous event", () => this.#jump(-1)),
        button("Next event", () => this.#jump(1)),
        html("label", {}, "of ", this.kinds), this.painted,
        button("Zoom in", () => this.#zoom(2)), button("Zoom out", () => this.#zoom(0.5))),
      this.list,
    );
    new ResizeObserver(() => this.#mark()).observe(this.marks);
  }

  /**
   * Begins with a recording.
   * @param {import("./messages.js").Welcome} welcome
   */
  begin(welcome) {
    this.on = welcome.playback;
    byId("playback").hidden = !this.on;
    if (!this.on) return;
    this.#length = welcome.length_s;
    this.#moments = welcome.moments;
    [this.#from, this.#span] = [0, welcome.length_s];
    const found = [...new Set(welcome.moments.map((moment) => moment.kind))];
    this.kinds.replaceChildren(html("option", { value: "" }, "all kinds"),
      ...found.map((kind) => html("option", { value: kind }, NAMES[kind] ?? kind)),
      ...(welcome.moments.some((moment) => moment.right === false) ? [html("option", { value: WRONG }, "wrong answers")] : []));
    this.painted.hidden = !welcome.moments.some((moment) => moment.condition);
    write(byId("playback-note"), `${clock(welcome.length_s)} long, ${welcome.moments.length} events`);
    this.#draw();
    this.go(this.at_s);
  }

  /** @param {number} rate_hz */
  tick(rate_hz) {
    if (rate_hz > 0) this.#tick_s = 1 / rate_hz;
  }

  /** Moments of the kinds that are chosen. */
  get #chosen() {
    const kind = this.kinds.value;
    return this.#moments.filter((moment) => !kind || moment.kind === kind || (kind === WRONG && moment.right === false));
  }

  #draw() {
    this.#listed = this.#chosen.slice(0, MOST_LISTED).map((moment) => {
      const shape = svg("svg", { viewBox: "-7 -7 14 14", class: "shape", "aria-hidden": "true" }, svg("path", { d: this.#shape(moment.kind, 0) }));
      const made = button("", () => this.go(moment.at_s), { "data-at": String(moment.at_s), class: "moment" });
      made.append(html("span", { class: "time" }, clock(moment.at_s)), shape,
        html("span", { class: "what" }, moment.kind), html("span", {}, moment.text));
      return made;
    });
    this.list.replaceChildren(...this.#listed.map((made) => html("li", {}, made)));
    this.list.hidden = this.#listed.length === 0;
    this.#current = -2;
    this.#mark();
    this.show();
  }

  /**
   * @param {string} kind
   * @param {number} x
   */
  #shape(kind, x) {
    return (SHAPES[kind] ?? SHAPES.note)(x);
  }

  #mark() {
    const width = this.marks.clientWidth - 2 * INSET_PX;
    if (!this.on || width <= 0) return;
    /** @type {Map<string, string>} */
    const paths = new Map();
    const within = this.#chosen.filter(({ at_s }) => at_s >= this.#from && at_s <= this.#from + this.#span);
    const painted = this.paint.value !== "";
    const conditions = [...new Set(this.#moments.map((moment) => moment.condition ?? ""))];
    const palette = colours().conditions;
    for (const { at_s, kind, right, condition } of within) {
      const x = Math.round((INSET_PX + ((at_s - this.#from) / (this.#span || 1)) * width) * 10) / 10;
      const sign = [kind, painted ? conditions.indexOf(condition ?? "") : "", right === false ? "wrong" : ""].join("|");
      paths.set(sign, (paths.get(sign) ?? "") + this.#shape(kind, x));
    }
    /** @type {(number: string) => Record<string, string>} */
    const fill = (number) =>
      number === "" || !conditions[Number(number)] ? {} : { fill: palette[Number(number) % palette.length] };
    this.marks.replaceChildren(...[...paths].map(([sign, d]) => {
      const [kind, number, wrong] = sign.split("|");
      const look = fill(number);
      return svg("path", { class: `${"fill" in look ? "" : "mark "}${kind} ${wrong}`.trim(), d, transform: "translate(0 8)", ...look });
    }));
    const key = (/** @type {string} */ kind, /** @type {Record<string, string>} */ look, /** @type {string} */ words) => html("span", {},
      svg("svg", { viewBox: "-7 -7 14 14", class: "shape", "aria-hidden": "true" },
        svg("path", { class: "fill" in look ? "" : `mark ${kind}`, d: this.#shape(kind, 0), ...look })), words);
    const kinds = [...new Set(within.map(({ kind }) => kind))];
    this.legend.replaceChildren(...kinds.map((kind) => key(kind, {}, NAMES[kind] ?? kind)),
      ...(painted ? conditions.flatMap((name, n) => (name ? [key("tuning", fill(String(n)), name)] : [])) : []));
  }

  /**
   * Shows less of the timeline, or more, about the time of now.
   * @param {number} times
   */
  #zoom(times) {
    this.#span = Math.min(Math.max(this.#span / times, Math.min(LEAST_SHOWN_S, this.#length)), this.#length);
    this.#from = this.at_s - this.#span / 2;
    this.#look();
    this.#mark();
    this.show();
  }

  /** Keeps what the timeline shows within the recording. */
  #look() {
    this.#from = Math.min(Math.max(this.#from, 0), this.#length - this.#span);
  }

  #toggle() {
    this.playing = !this.playing;
    if (this.playing && this.at_s >= this.#length - 1e-9) this.go(0);
    this.#then = NaN;
    this.wanted = true; // where it stops, the numbers are those of the picture
    write(this.play, this.playing ? "Pause" : "Play");
    this.wake();
  }

  /**
   * Goes to a time.
   * @param {number} at_s
   */
  go(at_s) {
    this.at_s = Math.min(Math.max(at_s, 0), this.#length);
    this.#since = null;
    this.wanted = true;
    this.show();
    this.wake();
  }

  /** @param {number} by_s */
  #step(by_s) {
    if (this.playing) this.#toggle();
    const since = this.at_s;
    this.go(this.at_s + by_s);
    if (by_s > 0) this.#since = since;
  }

  /** @param {number} way */
  #jump(way) {
    const edge = this.at_s + way * this.#tick_s * 0.5;
    const ahead = this.#chosen.filter((moment) => (way > 0 ? moment.at_s > edge : moment.at_s < edge));
    const to = way > 0 ? ahead[0] : ahead[ahead.length - 1];
    if (to) this.go(to.at_s);
  }

  /** @param {KeyboardEvent} event */
  #key(event) {
    const step = event.shiftKey ? 1 : STEP_S;
    const by = { ArrowRight: step, ArrowUp: step, ArrowLeft: -step, ArrowDown: -step, PageUp: 10, PageDown: -10 }[event.key];
    if (by) this.go(this.at_s + by);
    else if (event.key === "Home" || event.key === "End") this.go(event.key === "Home" ? 0 : this.#length);
    else return;
    event.preventDefault();
  }

  /**
   * Goes on by the time that has passed.
   * @param {number} now in ms
   */
  advance(now) {
    if (!this.playing) return;
    const passed = Number.isNaN(this.#then) ? 0 : Math.min((now - this.#then) / 1000, 2);
    this.#then = now;
    this.at_s = Math.min(this.at_s + passed * this.#speed, this.#length);
    this.wanted = true;
    if (this.at_s >= this.#length) this.#toggle();
  }

  /** What to ask for now. */
  request() {
    const asked = { at_s: this.at_s, since_s: this.#since };
    this.#since = this.at_s;
    this.wanted = false;
    return asked;
  }

  /** Shows where the recording is. */
  show() {
    const words = `${clock(this.at_s)} of ${clock(this.#length)}`;
    write(this.time, words);
    if (this.at_s < this.#from - 1e-9 || this.at_s > this.#from + this.#span + 1e-9) {
      this.#from = this.at_s - this.#span / 2;
      this.#look();
      this.#mark();
    }
    this.scrubber.min = String(this.#from);
    this.scrubber.max = String(this.#from + this.#span);
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
