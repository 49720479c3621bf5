/** What answers: the signals of a picture, and the cards of a game. */

import { button, byId, fixed, html, write } from "./elements.js";

/** The signals of a picture as a table. */
export class Signals {
  #rows = [];
  #made = "";

  show(state) {
    const { signals } = state;
    byId("signals").hidden = signals.length === 0;
    const made = JSON.stringify(signals);
    if (made === this.#made) return;
    this.#made = made;
    this.#rows = signals.map(({ name }) => ({ value: html("span"), bar: html("meter", { min: 0, max: 1, "aria-label": name }) }));
    const heads = ["signal", "value", "when"].map((words) => html("th", { scope: "col" }, words));
    const rows = signals.map(({ name, words }, n) => html("tr", {}, html("th", { scope: "row" }, name),
      html("td", {}, this.#rows[n].value, " ", this.#rows[n].bar), html("td", { class: "words" }, words)));
    byId("signal-rows").replaceChildren(html("table", {}, html("caption", {}, "Signals of the picture, from 0 to 1"),
      html("thead", {}, html("tr", {}, ...heads)), html("tbody", {}, ...rows)));
  }

  /** Tells the values of a frame. */
  read(frame) {
    this.#rows.forEach(({ value, bar }, n) => {
      write(value, fixed(frame.signals[n], 2));
      bar.value = frame.signals[n] || 0;
    });
  }
}

/** The table of a memory game: a card is turned by a press on its place. */
export class Cards {
  #made = "";
  #cards = [];

  constructor(ask) {
    this.ask = ask;
    byId("cards").addEventListener("keydown", (event) => this.#key(event));
  }

  show(state, steers) {
    byId("game").hidden = state.cards.length === 0;
    const made = `${steers} ${state.cards.map((row) => row.length).join()}`;
    if (made !== this.#made) {
      this.#made = made;
      this.#cards = state.cards.flat().map((_, place) =>
        (steers ? button("", () => this.ask({ ask: "press", command: "point", place }), { class: "card" }) : html("span", { class: "card" })));
      const left = [...this.#cards];
      byId("cards").replaceChildren(...state.cards.map((row) => html("div", { class: "row" }, ...left.splice(0, row.length))));
    }
    state.cards.flat().forEach(({ place, side, felt }, n) => {
      const card = this.#cards[n];
      write(card, `${place}, ${side}${felt ? ", under the hand" : ""}`);
      card.dataset.side = side;
      card.classList.toggle("felt", felt);
    });
  }

  /** Arrow keys go from card to card. */
  #key(event) {
    const at = this.#cards.indexOf(document.activeElement);
    const across = byId("cards").firstElementChild?.childElementCount ?? 1;
    const step = { ArrowRight: 1, ArrowLeft: -1, ArrowDown: across, ArrowUp: -across }[event.key];
    if (at < 0 || step === undefined) return;
    event.preventDefault();
    this.#cards[at + step]?.focus();
  }
}
