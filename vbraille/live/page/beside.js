/** The line under the hand in another mapping, as the array would feel it there. */

import { byId, write } from "./drawing.js";
import { Skin } from "./skin.js";

/** @typedef {import("./messages.js").State} State */
/** @typedef {import("./messages.js").Frame} Frame */

export class Beside {
  /** @type {State | null} */
  #state = null; // with the other mapping
  /** @type {Uint8Array[]} */
  #rows = [];
  #made = "";
  /** @type {Float32Array | null} */
  shown = null; // deflections that are drawn

  constructor() {
    this.skin = new Skin(byId("beside-deflection"), byId("beside-strain"), byId("beside-note"), "beside-heading");
  }

  /** @param {State} state */
  show(state) {
    const { beside } = state;
    byId("beside").hidden = !beside;
    this.#state = beside ? { ...state, rows_shown: beside.rows_shown } : null;
    if (!beside || !this.#state) return;
    write(byId("beside-heading"), `Beside it: ${beside.mapping}`);
    const made = beside.rows.join(" ");
    if (made !== this.#made) {
      this.#made = made;
      this.#rows = beside.rows.map((row) => Uint8Array.from(atob(row), (letter) => letter.charCodeAt(0)));
    }
    this.skin.show(this.#state);
  }

  /**
   * Deflections of the array at the place of a frame, in the other mapping.
   * @param {Frame} frame
   */
  #felt(frame) {
    const { array, beside } = /** @type {State} */ (this.#state);
    const found = new Float32Array(frame.deflections.length);
    if (!array || !beside) return found;
    for (let n = 0; n < found.length; n++) {
      const column = n % array.columns;
      const x = frame.x_mm + (column - (array.columns - 1) / 2) * array.column_pitch_mm;
      const row = this.#rows[Math.floor(n / array.columns)];
      const place = Math.round((x - beside.first_mm) / beside.step_mm);
      found[n] = row ? row[Math.min(Math.max(place, 0), row.length - 1)] / 255 : 0;
    }
    return found;
  }

  /** @param {Frame} frame */
  move(frame) {
    this.shown = this.#state ? this.#felt(frame) : null;
    if (this.#state && this.shown) this.skin.move(this.#state, { ...frame, deflections: this.shown });
  }

  /** Tells in words what is drawn. */
  tell() {
    if (this.#state) this.skin.tell();
  }
}
