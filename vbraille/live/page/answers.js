/** What answers: the signals of a picture, its layers that are off, and the cards of a game. */

import { button, byId, fixed, html, write } from "./drawing.js";

/** @typedef {import("./messages.js").State} State */
/** @typedef {import("./messages.js").Frame} Frame */

/** The signals of a picture as a table, and which layers its switches hide. */
export class Signals {
  /** @type {{value: HTMLElement, bar: HTMLMeterElement}[]} */
  #rows = [];
  #made = "";

  constructor() {
    this.button = byId("show-off");
    this.button.addEventListener("click", () => {
      const shown = document.body.classList.toggle("bare");
      this.button.setAttribute("aria-pressed", String(!shown));
    });
  }

  /** @param {State} state */
  show(state) {
    const { signals } = state;
    byId("signals").hidden = signals.length === 0;
    const off = state.scene?.off ?? [];
    byId("off").hidden = off.length === 0;
    write(byId("off-words"), off.length ? `Layers that are off: ${off.join(", ")}.` : "");
    const made = JSON.stringify(signals);
    if (made === this.#made) return;
    this.#made = made;
    this.#rows = [];
    const rows = signals.map(({ name, words }) => {
      const value = html("span", {}, "–");
      const bar = html("meter", { min: 0, max: 1, "aria-label": name });
      this.#rows.push({ value, bar });
      return html("tr", {}, html("th", { scope: "row" }, name), html("td", {}, value, " ", bar), html("td", { class: "words" }, words));
    });
    const heads = ["signal", "value", "when"].map((words) => html("th", { scope: "col" }, words));
    byId("signal-rows").replaceChildren(html("table", {}, html("caption", {}, "Signals of the picture, from 0 to 1"),
      html("thead", {}, html("tr", {}, ...heads)), html("tbody", {}, ...rows)));
  }

  /**
   * Tells the values of a frame.
   * @param {Frame} frame
   */
  read(frame) {
    this.#rows.forEach(({ value, bar }, n) => {
      const now = frame.signals[n];
      write(value, fixed(now, 2));
      bar.value = Number.isFinite(now) ? now : 0;
    });
  }
}

/** The table of a memory game: a card is turned by a press on its place. */
export class Cards {
  #made = "";
  /** @type {HTMLElement[]} */
  #cards = [];

  /** @param {(request: {ask: string} & Record<string, unknown>) => void} ask */
  constructor(ask) {
    this.ask = ask;
    byId("cards").addEventListener("keydown", (event) => this.#key(event));
  }

  /**
   * @param {State} state
   * @param {boolean} steers
   */
  show(state, steers) {
    byId("game").hidden = state.cards.length === 0;
    const made = `${steers} ${state.cards.map((row) => row.length).join()}`;
    if (made !== this.#made) {
      this.#made = made;
      let place = 0;
      this.#cards = [];
      byId("cards").replaceChildren(...state.cards.map((row) => html("div", { class: "row" }, ...row.map(() => {
        const at = place++;
        const card = steers ? button("", () => this.ask({ ask: "press", command: "POINT", place: at })) : html("span");
        card.classList.add("card");
        this.#cards.push(card);
        return card;
      }))));
    }
    state.cards.flat().forEach(({ place, side, felt }, n) => {
      const card = this.#cards[n];
      write(card, `${place}, ${side}${felt ? ", under the hand" : ""}`);
      card.dataset.side = side;
      card.classList.toggle("felt", felt);
    });
  }

  /**
   * Arrow keys go from card to card.
   * @param {KeyboardEvent} event
   */
  #key(event) {
    const at = this.#cards.indexOf(/** @type {HTMLElement} */ (document.activeElement));
    const across = byId("cards").firstElementChild?.childElementCount ?? 1;
    const step = { ArrowRight: 1, ArrowLeft: -1, ArrowDown: across, ArrowUp: -across }[event.key];
    if (at < 0 || step === undefined) return;
    event.preventDefault();
    this.#cards[at + step]?.focus();
  }
}
