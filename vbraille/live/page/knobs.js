/** The knobs of the braille style and the reader's commands: what keys do, by mouse and by touch. */

import { button, byId, html, short, write } from "./drawing.js";

/** @typedef {import("./messages.js").State} State */
/** @typedef {import("./messages.js").KnobShown} KnobShown */

/** A length whose bounds are further apart than this is turned by equal factors, not equal steps. */
const WIDE = 100;

/** One knob: step buttons, a slider and a number. */
class Knob {
  #value = 0;
  busy = false; // whether a person turns it here
  #typing = false; // whether a number is being typed: it stays until it is taken

  /**
   * @param {KnobShown} knob
   * @param {(name: string, value: number) => void} turn
   */
  constructor(knob, turn) {
    this.knob = knob;
    this.turn = turn;
    const id = `knob-${knob.name}`;
    const unit = knob.unit ? ` ${knob.unit}` : "";
    this.slider = html("input", { type: "range", id, step: "any", min: 0, max: 1 });
    this.number = html("input", {
      type: "number", id: `${id}-number`, step: "any", min: knob.low, max: knob.high, inputmode: "decimal",
      "aria-label": `${knob.label}${knob.unit ? ` in ${knob.unit}` : ""}, as a number`,
    });
    const by = short(knob.step) + unit;
    this.less = button("−", () => this.#step(-1), { "aria-label": `${knob.label}: less by ${by}` });
    this.more = button("+", () => this.#step(1), { "aria-label": `${knob.label}: more by ${by}` });
    this.reason = html("p", { class: "reason", id: `${id}-reason` });
    this.plain = html("span", { class: "plain" }); // in place of all of them where it cannot be turned
    this.entry = html("span", { class: "value" }, this.number, html("span", { "aria-hidden": "true" }, unit));
    this.element = html("div", { class: "knob" },
      html("label", { for: id }, knob.label), this.less, this.slider, this.more, this.entry, this.plain, this.reason);
    this.slider.addEventListener("input", () => this.#set(this.#snap(this.#fromSlider())));
    this.slider.addEventListener("keydown", (event) => this.#key(event));
    this.number.addEventListener("input", () => (this.#typing = true));
    this.number.addEventListener("blur", () => {
      this.#typing = false;
      this.#write();
    });
    this.number.addEventListener("change", () => {
      this.#typing = false;
      const typed = Number(this.number.value);
      if (this.number.value !== "" && Number.isFinite(typed)) this.#set(this.#bound(typed));
      this.#write();
    });
    this.slider.addEventListener("pointerdown", () => (this.busy = true));
    for (const end of ["pointerup", "pointercancel", "blur"]) this.slider.addEventListener(end, () => (this.busy = false));
  }

  get #steep() {
    return this.knob.low > 0 && this.knob.high / this.knob.low >= WIDE;
  }

  #fromSlider() {
    const { low, high } = this.knob;
    const share = Number(this.slider.value);
    return this.#steep ? low * (high / low) ** share : low + (high - low) * share;
  }

  #toSlider() {
    const { low, high } = this.knob;
    return this.#steep ? Math.log(this.#value / low) / Math.log(high / low) : (this.#value - low) / (high - low || 1);
  }

  /** @param {number} value */
  #bound(value) {
    return Math.min(Math.max(Math.round(value * 1e6) / 1e6, this.knob.low), this.knob.high);
  }

  /**
   * A value that keys come to from where the reader's knob stands.
   * @param {number} value
   */
  #snap(value) {
    const { step, value: from } = this.knob;
    return this.#bound(from + Math.round((value - from) / step) * step);
  }

  /** @param {number} steps */
  #step(steps) {
    this.#set(this.#bound(this.#value + steps * this.knob.step));
  }

  /** @param {KeyboardEvent} event */
  #key(event) {
    const steps = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: 5, PageDown: -5 }[event.key];
    if (event.key === "Home" || event.key === "End") this.#set(event.key === "Home" ? this.knob.low : this.knob.high);
    else if (steps) this.#step(steps);
    else return;
    event.preventDefault();
  }

  /** @param {number} value */
  #set(value) {
    const changed = value !== this.#value;
    this.#value = value;
    this.#write();
    if (changed) this.turn(this.knob.name, value);
  }

  #write() {
    const { label, unit } = this.knob;
    this.slider.value = String(this.#toSlider());
    this.slider.setAttribute("aria-valuetext", `${short(this.#value)} ${unit}`.trim());
    if (!this.#typing) this.number.value = String(this.#value);
    this.slider.title = `${label}: ${short(this.#value)} ${unit}`.trim();
  }

  /**
   * Shows the reader's knob.
   * @param {KnobShown} knob
   * @param {boolean} steers
   */
  show(knob, steers) {
    this.knob = knob;
    const off = !steers || knob.fixed !== "";
    for (const part of [this.slider, this.entry, this.less, this.more]) part.hidden = off;
    this.plain.hidden = !off;
    write(this.plain, `${short(knob.value)} ${knob.unit}`.trim());
    write(this.reason, knob.fixed);
    this.reason.hidden = !knob.fixed;
    if (this.busy) return;
    this.#value = knob.value;
    this.#write();
  }
}

export class Knobs {
  /** @type {Map<string, Knob>} */
  #knobs = new Map();
  /** @type {Map<string, number>} */
  #turned = new Map();

  /** @param {(request: {ask: string} & Record<string, unknown>) => void} ask */
  constructor(ask) {
    this.ask = ask;
    /** @type {() => void} */
    this.wake = () => {};
    /** @type {Map<string, HTMLButtonElement>} */
    this.buttons = new Map();
  }

  /**
   * Shows the knobs.
   * @param {State} state
   * @param {boolean} steers
   * @param {string} why reason why nothing can be turned here; empty if it can
   */
  show(state, steers, why) {
    const names = state.knobs.map((knob) => knob.name).join();
    if (names !== [...this.#knobs.keys()].join()) {
      const turn = (/** @type {string} */ name, /** @type {number} */ value) => {
        this.#turned.set(name, value);
        this.wake();
      };
      this.#knobs = new Map(state.knobs.map((knob) => [knob.name, new Knob(knob, turn)]));
      byId("knobs").replaceChildren(...[...this.#knobs.values()].map((knob) => knob.element));
    }
    for (const knob of state.knobs) {
      // What was asked for here and is not yet sent stays.
      if (!this.#turned.has(knob.name)) this.#knobs.get(knob.name)?.show(knob, steers);
    }
    this.#offer(state.commands);
    byId("commands").hidden = !steers || state.commands.length === 0;
    const pause = this.buttons.get("PAUSE");
    if (pause) write(pause, state.paused ? "Go on" : "Rest the array");
    write(byId("knobs-note"), why);
    byId("knobs-note").hidden = !why;
  }

  /** @param {{name: string, words: string}[]} commands */
  #offer(commands) {
    if (commands.map(({ name }) => name).join() !== [...this.buttons.keys()].join()) {
      const press = (/** @type {string} */ command) => button("", () => this.ask({ ask: "press", command }));
      this.buttons = new Map(commands.map(({ name }) => [name, press(name)]));
      byId("commands").replaceChildren(...this.buttons.values());
    }
    for (const { name, words } of commands) {
      const made = /** @type {HTMLButtonElement} */ (this.buttons.get(name));
      if (name !== "PAUSE") write(made, words.charAt(0).toUpperCase() + words.slice(1));
    }
  }

  /** Sends the newest turn of each knob; called once for each drawn frame. */
  send() {
    for (const [knob, value] of this.#turned) this.ask({ ask: "turn", knob, value });
    this.#turned.clear();
  }
}
