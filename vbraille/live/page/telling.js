/** What is drawn, in words and numbers: readings, the line, the log, times, and tables. */

import { degrees, spelled, under } from "./braille.js";
import { byId, fixed, html, write } from "./drawing.js";
import { sayFlags } from "./messages.js";
import { rowWords, strains } from "./skin.js";

/** @typedef {import("./messages.js").State} State */
/** @typedef {import("./messages.js").Frame} Frame */

const MOST_SAID = 60; // sentences that stay in the log
const RATE_S = 1; // over which the rate is measured

/** A list of names and values of which only those that change are written. */
class Facts {
  /** @type {Map<string, HTMLElement>} */
  #values = new Map();

  /** @param {HTMLElement} list */
  constructor(list) {
    this.list = list;
  }

  /** @param {[string, string][]} facts */
  show(facts) {
    const names = facts.map(([name]) => name);
    if (names.join("\n") !== [...this.#values.keys()].join("\n")) {
      this.#values = new Map(names.map((name) => [name, html("dd")]));
      const pairs = [...this.#values].map(([name, value]) => html("div", {}, html("dt", {}, name), value));
      this.list.replaceChildren(...pairs);
    }
    for (const [name, value] of facts) write(/** @type {HTMLElement} */ (this.#values.get(name)), value || "–");
  }
}

export class Telling {
  #readout = new Facts(byId("readout"));
  #facts = new Facts(byId("facts"));
  #said = -1; // number of sentences that stand in the log or went out of it
  #rate = NaN;
  /** @type {[number, number]} */
  #since = [NaN, NaN]; // tick and time from which the rate is measured
  #print = "";
  /** @type {[number, number, number]} */
  #down = [NaN, NaN, NaN]; // time and place from which the speed down the page is measured, and that speed

  /**
   * What the state says.
   * @param {State} state
   */
  show(state) {
    write(byId("title"), state.title || "vbraille");
    document.title = state.title ? `${state.title} – vbraille live view` : "vbraille live view";
    write(byId("place"), state.place);
    const device = [state.blind ? "what is felt stays hidden" : "", state.device,
      state.paused ? "paused" : "", state.done ? "reading is over" : "", state.held ? "the hand is held by a page" : ""];
    write(byId("device"), device.filter(Boolean).join(" · "));
    byId("print").hidden = state.blind;
    write(byId("mapping"), state.mapping.replace(/^mapping: /, "mapping "));
    this.#log(state);
  }

  /**
   * Adds what was said since.
   * @param {State} state
   */
  #log(state) {
    const log = byId("said");
    const end = state.said_before + state.said.length;
    const fresh = end < this.#said ? state.said : state.said.slice(Math.max(this.#said - state.said_before, 0));
    if (end < this.#said) log.replaceChildren();
    // What was said before the page was opened is there to be read, and is not announced.
    log.setAttribute("aria-live", this.#said < 0 ? "off" : "polite");
    this.#said = end;
    if (fresh.length === 0) return;
    for (const sentence of fresh) log.append(html("p", {}, sentence));
    while (log.childElementCount > MOST_SAID) log.firstElementChild?.remove();
    log.scrollTop = log.scrollHeight;
  }

  /**
   * The readings of a frame.
   * @param {State} state
   * @param {Frame} frame
   */
  read(state, frame) {
    const two = (state.array?.height_mm ?? 0) > 0;
    const here = state.blind ? null : under(state, frame);
    /** @type {[string, string][]} */
    const readings = [["x", `${fixed(frame.x_mm)} mm`]];
    if (two) readings.push(["y", `${fixed(frame.y_mm)} mm`]);
    if (state.array?.turns) readings.push(["turned", `${degrees(frame.theta_rad)}°`]);
    if (two) readings.push(["speed along", `${fixed(frame.vx_mm_s, 0)} mm/s`], ["speed down", `${fixed(this.#falling(frame), 0)} mm/s`]);
    else readings.push(["speed", `${fixed(frame.vx_mm_s, 0)} mm/s`]);
    if (!state.blind && !state.scene) {
      readings.push(
        ["line", here ? String(here.line.number) : ""],
        ["cell", here && here.cell >= 0 ? String(here.cell + 1) : ""],
        ["dots", here && here.cell >= 0 ? here.dots.join(" ") || "none" : ""],
        ["character", here ? here.character.replace(" ", "blank") : ""],
        ["word", here ? here.line.text.slice(...here.word) : ""],
      );
    }
    this.#readout.show(readings);
    if (state.scene) write(byId("print"), state.scene.description);
    else this.#printed(here);
    this.#time(state, frame);
  }

  /**
   * Speed down the page, in mm/s: from one reading to the next.
   * @param {Frame} frame
   */
  #falling(frame) {
    const [time, y, speed] = this.#down;
    const passed = frame.time_s - time;
    if (passed === 0) return speed; // the picture stands still
    const near = passed > 0 && passed < RATE_S;
    this.#down = [frame.time_s, frame.y_mm, near ? (frame.y_mm - y) / passed : NaN];
    return this.#down[2];
  }

  /** @param {import("./braille.js").Under | null} here */
  #printed(here) {
    const print = byId("print");
    const made = here ? JSON.stringify([here.line.text, here.word, here.source]) : "";
    if (made === this.#print) return;
    this.#print = made;
    if (!here) return print.replaceChildren();
    const { text } = here.line;
    if (!text) return print.replaceChildren(spelled(here.line.cells));
    const [from, to] = here.word;
    const [first, last] = here.source;
    if (to <= from) return print.replaceChildren(text);
    print.replaceChildren(text.slice(0, from), html("mark", {}, text.slice(from, first),
      html("b", {}, text.slice(first, last)), text.slice(last, to)), text.slice(to));
  }

  /**
   * @param {State} state
   * @param {Frame} frame
   */
  #time(state, frame) {
    const [tick, time] = this.#since;
    const passed = frame.time_s - time;
    if (!(passed >= 0 && passed < 10 * RATE_S)) this.#since = [frame.tick, frame.time_s];
    else if (passed >= RATE_S) {
      this.#rate = (frame.tick - tick) / passed;
      this.#since = [frame.tick, frame.time_s];
    }
    const wanted = state.array ? ` of ${fixed(state.array.rate_hz, 0)}` : "";
    const remarks = sayFlags(frame.flags);
    this.#facts.show([
      ["rate", `${fixed(this.#rate, 0)}${wanted} Hz`],
      ["late ticks", String(frame.late)],
      ["lateness", `${fixed(frame.lateness_us, 0)} µs`],
      ["work of a tick", `${fixed(frame.work_us, 0)} µs`],
      ["age when sent", `${fixed(frame.age_ms, 1)} ms`],
      ["tick", String(frame.tick)],
      ["faded in", `${fixed(100 * frame.share, 0)} %`],
      ["remarks", remarks || "none"],
      // What this page measures is said once.
      ...state.facts.filter(([name]) => !["rate", "late ticks"].includes(name)),
    ]);
  }
}

/**
 * All that is drawn, as tables of this moment.
 * @param {State} state
 * @param {Frame | null} frame
 * @returns {Element[]}
 */
export function tables(state, frame) {
  const array = state.array;
  if (state.blind) return [html("p", {}, "What is felt stays hidden: no dots and no deflections.")];
  if (!array || !frame) return [html("p", {}, "There is no frame yet.")];
  const columns = Array.from({ length: array.columns }, (_, n) => n + 1);
  const cell = (/** @type {number} */ n, /** @type {ArrayLike<number>} */ values, places = 2) => fixed(values[n], places);
  const row = (/** @type {number} */ n) => [`row ${n + 1}`, rowWords(state.rows_shown[n])].filter(Boolean).join(", ");
  const grid = (/** @type {string} */ title, /** @type {string[]} */ heads, /** @type {(r: number, c: number) => string} */ value) =>
    table(title, ["row", ...heads],
      Array.from({ length: array.rows }, (_, r) => [row(r), ...heads.map((_, c) => value(r, c))]));
  const strain = strains(array, frame.deflections).map((value) => 100 * value);
  const shown = frame.deflections.length > 0;
  const pieces = [
    html("p", {}, `Tick ${frame.tick}, x ${fixed(frame.x_mm, 2)} mm` +
      (array.height_mm > 0 ? `, y ${fixed(frame.y_mm, 2)} mm` : "") + "."),
    table("Lines of the page", ["line", "print", "braille", "from x (mm)", "top (mm)"], state.lines.map((line) => [
      `${line.number}${line.under ? ", under the hand" : ""}`, line.text || "–", spelled(line.cells),
      fixed(line.start_mm), fixed(line.top_mm)])),
  ];
  if (shown) {
    pieces.splice(1, 0,
      grid("Deflection of each actuator, 0 (rest) to 1 (full swing)", columns.map((n) => `column ${n}`),
        (r, c) => cell(r * array.columns + c, frame.deflections)),
      grid("Strain between neighbours in %, above 0 where the skin is stretched",
        columns.slice(1).map((n) => `${n - 1} to ${n}`), (r, c) => cell(r * (array.columns - 1) + c, strain, 1)));
  }
  return pieces;
}

/**
 * A table that can be scrolled by keys where it is wider than the page.
 * @param {string} title
 * @param {string[]} heads
 * @param {string[][]} rows
 */
function table(title, heads, rows) {
  const head = html("tr", {}, ...heads.map((words) => html("th", { scope: "col" }, words)));
  const body = rows.map(([first, ...rest]) =>
    html("tr", {}, html("th", { scope: "row" }, first), ...rest.map((words) => html("td", {}, words))));
  const made = html("table", {}, html("caption", {}, title), html("thead", {}, head), html("tbody", {}, ...body));
  return html("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": title }, made);
}
