/** The knobs of the braille style and the reader's commands: what keys do, by mouse and by touch. */

import { button, byId, clamp, html, short, write } from "./elements.js";

const WIDE = 100; // a knob whose bounds are further apart is turned by equal factors, not equal steps

/** One knob: step buttons, a slider and a number. */
class Knob {
  busy = false; // whether a person turns it here
  #value = 0;
  #typing = false; // a number that is being typed stays until it is taken

  constructor(knob, turn) {
    this.knob = knob;
    this.turn = turn;
    const id = `knob-${knob.name}`;
    const unit = knob.unit && ` ${knob.unit}`;
    this.slider = html("input", { type: "range", id, step: "any", min: 0, max: 1 });
    this.number = html("input", {
      type: "number", id: `${id}-number`, step: "any", min: knob.low, max: knob.high, inputmode: "decimal",
      "aria-label": `${knob.label}${knob.unit && ` in ${knob.unit}`}, as a number`,
    });
    const by = (way) => ({ "aria-label": `${knob.label}: ${way} by ${short(knob.step)}${unit}` });
    this.less = button("−", () => this.#step(-1), by("less"));
    this.more = button("+", () => this.#step(1), by("more"));
    this.reason = html("p", { class: "reason", id: `${id}-reason` });
    this.plain = html("span", { class: "plain" }); // in place of all of them where it cannot be turned
    this.entry = html("span", { class: "value" }, this.number, html("span", { "aria-hidden": "true" }, unit));
    this.element = html("div", { class: "knob" },
      html("label", { for: id }, knob.label), this.less, this.slider, this.more, this.entry, this.plain, this.reason);
    this.slider.addEventListener("input", () => {
      const { step, value } = this.knob;
      this.#set(value + Math.round((this.#fromSlider() - value) / step) * step);
    });
    this.slider.addEventListener("keydown", (event) => this.#key(event));
    this.number.addEventListener("input", () => (this.#typing = true));
    this.number.addEventListener("blur", () => this.#typed());
    this.number.addEventListener("change", () => {
      const typed = this.number.value === "" ? NaN : Number(this.number.value);
      this.#typing = false;
      if (Number.isFinite(typed)) this.#set(typed);
      this.#typed();
    });
    this.slider.addEventListener("pointerdown", () => (this.busy = true));
    for (const end of ["pointerup", "pointercancel", "blur"]) this.slider.addEventListener(end, () => (this.busy = false));
  }

  #typed() {
    this.#typing = false;
    this.#write();
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

  #step(steps) {
    this.#set(this.#value + steps * this.knob.step);
  }

  #key(event) {
    const steps = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: 5, PageDown: -5 }[event.key];
    if (event.key === "Home" || event.key === "End") this.#set(event.key === "Home" ? this.knob.low : this.knob.high);
    else if (steps) this.#step(steps);
    else return;
    event.preventDefault();
  }

  #set(wanted) {
    const value = clamp(Math.round(wanted * 1e6) / 1e6, this.knob.low, this.knob.high);
    const changed = value !== this.#value;
    this.#value = value;
    this.#write();
    if (changed) this.turn(this.knob.name, value);
  }

  #write() {
    const { unit } = this.knob;
    this.slider.value = String(this.#toSlider());
    this.slider.setAttribute("aria-valuetext", `${short(this.#value)} ${unit}`.trim());
    if (!this.#typing) this.number.value = String(this.#value);
    write(this.plain, `${short(this.#value)} ${unit}`.trim());
  }

  /** Shows what the reader's knob is turned to. */
  show(knob, steers) {
    this.knob = knob;
    if (!this.busy) this.#value = knob.value;
    this.#write();
    const turns = steers && !knob.fixed;
    for (const part of [this.less, this.slider, this.more, this.entry]) part.hidden = !turns;
    this.plain.hidden = turns;
    write(this.reason, steers ? knob.fixed : "");
  }
}

export class Knobs {
  #knobs = new Map();
  #buttons = new Map();
  #turned = new Map();

  constructor(ask, wake) {
    this.ask = ask;
    this.wake = wake;
  }

  /** Shows the knobs and commands, and why nothing can be turned; empty if it can. */
  show(state, steers, whyNot) {
    if (state.knobs.map(({ name }) => name).join() !== [...this.#knobs.keys()].join()) {
      const turn = (name, value) => (this.#turned.set(name, value), this.wake());
      this.#knobs = new Map(state.knobs.map((knob) => [knob.name, new Knob(knob, turn)]));
      byId("knobs").replaceChildren(...[...this.#knobs.values()].map((knob) => knob.element));
    }
    // What was asked for here and is not yet sent stays.
    for (const knob of state.knobs) if (!this.#turned.has(knob.name)) this.#knobs.get(knob.name).show(knob, steers);
    write(byId("knobs-note"), whyNot);
    const commands = steers ? state.commands : [];
    if (commands.map(({ name }) => name).join() !== [...this.#buttons.keys()].join()) {
      const press = (command) => button("", () => this.ask({ ask: "press", command }));
      this.#buttons = new Map(commands.map(({ name }) => [name, press(name)]));
      byId("commands").replaceChildren(...this.#buttons.values());
    }
    for (const { name, words } of commands) {
      const shown = name === "pause" ? (state.paused ? "go on" : "rest the array") : words;
      write(this.#buttons.get(name), shown.charAt(0).toUpperCase() + shown.slice(1));
    }
  }

  /** Sends the newest turn of each knob; called once for each drawn frame. */
  send() {
    for (const [knob, value] of this.#turned) this.ask({ ask: "turn", knob, value });
    this.#turned.clear();
  }
}
