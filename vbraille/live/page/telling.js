/** What is drawn, in words and numbers: readings, the line, what was said, times, and tables. */

import { degrees, rowWords, under, unicode } from "./braille.js";
import { sayFlags } from "./connection.js";
import { byId, fixed, html, write } from "./elements.js";
import { strains } from "./skin.js";

const MOST_SAID = 60; // sentences that stay in the log
const RATE_S = 1; // over which the rate is measured

/** A list of names and values of which only those that change are written. */
class Facts {
  #values = new Map();

  constructor(list) {
    this.list = list;
  }

  show(facts) {
    if (facts.map(([name]) => name).join("\n") !== [...this.#values.keys()].join("\n")) {
      this.#values = new Map(facts.map(([name]) => [name, html("dd")]));
      this.list.replaceChildren(...[...this.#values].map(([name, value]) => html("div", {}, html("dt", {}, name), value)));
    }
    for (const [name, value] of facts) write(this.#values.get(name), value || "–");
  }
}

export class Telling {
  #readout = new Facts(byId("readout"));
  #facts = new Facts(byId("facts"));
  #said = -1; // number of sentences that stand in the log or went out of it
  #rate = NaN;
  #since = [NaN, NaN]; // tick and time from which the rate is measured
  #print = "";

  /** What the state says. */
  show(state) {
    write(byId("title"), state.title || "vbraille");
    document.title = state.title ? `${state.title} – vbraille live view` : "vbraille live view";
    write(byId("place"), state.place);
    const device = [state.blind && "what is felt stays hidden", state.device, state.paused && "paused",
      state.done && "reading is over", state.held && "the hand is held by a page"];
    write(byId("device"), device.filter(Boolean).join(" · "));
    byId("print").hidden = state.blind;
    write(byId("mapping"), state.mapping.replace(/^mapping: /, "mapping "));
    this.#log(state);
  }

  /** Adds what was said since. */
  #log({ said, said_before }) {
    const log = byId("said");
    const end = said_before + said.length;
    const anew = end < this.#said;
    const fresh = anew ? said : said.slice(Math.max(this.#said - said_before, 0));
    if (anew) log.replaceChildren();
    // What was said before the page was opened is there to be read, and is not announced.
    log.setAttribute("aria-live", this.#said < 0 ? "off" : "polite");
    this.#said = end;
    if (!fresh.length) return;
    log.append(...fresh.map((sentence) => html("p", {}, sentence)));
    while (log.childElementCount > MOST_SAID) log.firstElementChild.remove();
    log.scrollTop = log.scrollHeight;
  }

  /** The readings of a frame. */
  read(state, frame) {
    const two = state.array?.height_mm > 0;
    const here = state.blind ? null : under(state, frame);
    const on = here && here.cell >= 0;
    this.#readout.show([
      ["x", `${fixed(frame.x_mm)} mm`],
      ...(two ? [["y", `${fixed(frame.y_mm)} mm`]] : []),
      ...(state.array?.turns ? [["turned", `${degrees(frame.theta_rad)}°`]] : []),
      ["speed along", `${fixed(frame.vx_mm_s, 0)} mm/s`],
      ...(state.blind || state.scene ? [] : [
        ["cell", on && String(here.cell + 1)],
        ["dots", on && (here.dots.join(" ") || "none")],
        ["character", here?.character.replace(" ", "blank")],
        ["word", here?.line.text.slice(...here.word)],
      ]),
    ]);
    if (state.scene) write(byId("print"), state.scene.description);
    else this.#printed(here);
    this.#time(state, frame);
  }

  #printed(here) {
    const made = here ? JSON.stringify([here.line.text, here.line.cells, here.word, here.source]) : "";
    if (made === this.#print) return;
    this.#print = made;
    if (!here) return byId("print").replaceChildren();
    const { line: { text, cells }, word: [from, to], source: [first, last] } = here;
    byId("print").replaceChildren(...(!text ? [unicode(cells)] : to <= from ? [text] : [text.slice(0, from),
      html("mark", {}, text.slice(from, first), html("b", {}, text.slice(first, last)), text.slice(last, to)), text.slice(to)]));
  }

  #time(state, frame) {
    const [tick, time] = this.#since;
    const passed = frame.time_s - time;
    const near = passed >= 0 && passed < 10 * RATE_S;
    if (near && passed >= RATE_S) this.#rate = (frame.tick - tick) / passed;
    if (!near || passed >= RATE_S) this.#since = [frame.tick, frame.time_s];
    this.#facts.show([
      ["rate", `${fixed(this.#rate, 0)}${state.array ? ` of ${fixed(state.array.rate_hz, 0)}` : ""} Hz`],
      ["late ticks", String(frame.late)],
      ["lateness", `${fixed(frame.lateness_us, 0)} µs`],
      ["work of a tick", `${fixed(frame.work_us, 0)} µs`],
      ["age when sent", `${fixed(frame.age_ms)} ms`],
      ["tick", String(frame.tick)],
      ["faded in", `${fixed(100 * frame.share, 0)} %`],
      ["remarks", sayFlags(frame.flags) || "none"],
      // What this page measures is said once.
      ...state.facts.filter(([name]) => !["rate", "late ticks"].includes(name)),
    ]);
  }
}

/** All that is drawn, as tables of this moment. */
export function tables(state, frame) {
  const { array } = state;
  if (state.blind) return [html("p", {}, "What is felt stays hidden: no dots and no deflections.")];
  if (!array || !frame) return [html("p", {}, "There is no frame yet.")];
  const grid = (title, heads, values, places) => table(title, ["row", ...heads], Array.from({ length: array.rows }, (_, row) => [
    [`row ${row + 1}`, rowWords(state.rows_shown[row])].filter(Boolean).join(", "),
    ...heads.map((_, column) => fixed(values[row * heads.length + column], places)),
  ]));
  const columns = Array.from({ length: array.columns }, (_, n) => n + 1);
  const strain = strains(array, frame.deflections).map((value) => 100 * value);
  const y = array.height_mm > 0 ? `, y ${fixed(frame.y_mm, 2)} mm` : "";
  return [
    html("p", {}, `Tick ${frame.tick}, x ${fixed(frame.x_mm, 2)} mm${y}.`),
    ...(frame.deflections.length ? [
      grid("Deflection of each actuator, 0 (rest) to 1 (full swing)", columns.map((n) => `column ${n}`), frame.deflections, 2),
      grid("Strain between neighbours in %, above 0 where the skin is stretched", columns.slice(1).map((n) => `${n - 1} to ${n}`), strain, 1),
    ] : []),
    table("Lines of the page", ["line", "print", "braille", "from x (mm)", "top (mm)"], state.lines.map((line, n) => [
      `${n + 1}${line.under ? ", under the hand" : ""}`, line.text || "–", unicode(line.cells), fixed(line.start_mm), fixed(line.top_mm)])),
  ];
}

/** A table that can be scrolled by keys where it is wider than the page. */
function table(title, heads, rows) {
  const head = html("tr", {}, ...heads.map((words) => html("th", { scope: "col" }, words)));
  const body = rows.map(([first, ...rest]) => html("tr", {}, html("th", { scope: "row" }, first), ...rest.map((words) => html("td", {}, words))));
  return html("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": title },
    html("table", {}, html("caption", {}, title), html("thead", {}, head), html("tbody", {}, ...body)));
}
