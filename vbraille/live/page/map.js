/** The deflection map: asked for, shown, and saved as a file. */

import { byId, html, write } from "./drawing.js";
import { save } from "./saving.js";

export class DeflectionMap {
  /** @type {("show" | "save")[]} */
  #waiting = [];
  #address = "";

  /** @param {(request: {ask: string} & Record<string, unknown>) => boolean} ask */
  constructor(ask) {
    this.ask = ask;
    this.title = "";
    /** @type {() => number | null} */
    this.time = () => null;
    byId("draw-map").addEventListener("click", () => this.#want("png", "show"));
    byId("save-png").addEventListener("click", () => this.#want("png", "save"));
    byId("save-svg").addEventListener("click", () => this.#want("svg", "save"));
  }

  /**
   * @param {"png" | "svg"} form
   * @param {"show" | "save"} purpose
   */
  #want(form, purpose) {
    const at_s = this.time();
    if (!this.ask({ ask: "map", form, ...(at_s === null ? {} : { at_s }) })) {
      return write(byId("map-words"), "There is no connection to ask for a map.");
    }
    this.#waiting.push(purpose);
    write(byId("map-words"), "The map is being drawn.");
  }

  /**
   * Takes a map.
   * @param {{svg: boolean, file: Blob}} map
   */
  take(map) {
    const purpose = this.#waiting.shift();
    const form = map.svg ? "svg" : "png";
    if (purpose === "save") {
      save(`deflection-map.${form}`, map.file);
      return write(byId("map-words"), `The map is saved as deflection-map.${form}.`);
    }
    if (this.#address) URL.revokeObjectURL(this.#address);
    this.#address = URL.createObjectURL(map.file);
    const words = `Deflection map of ${this.title || "the page"}, to scale`;
    byId("map-figure").replaceChildren(html("img", { src: this.#address, alt: words }), html("figcaption", {}, words));
    byId("map-figure").hidden = false;
    write(byId("map-words"), "The map is drawn.");
  }

  /**
   * Takes it that a map is refused; false if none was asked for.
   * @param {string} why
   */
  refused(why) {
    if (this.#waiting.shift() === undefined) return false;
    write(byId("map-words"), why);
    return true;
  }

  /** Forgets what was asked for: no answer will come. */
  lost() {
    if (this.#waiting.length) write(byId("map-words"), "");
    this.#waiting = [];
  }

  /** @param {boolean} blind */
  show(blind) {
    byId("map").hidden = blind;
    if (blind) byId("map-figure").replaceChildren();
  }
}
