/**
 * The talk with the server: it is begun again when it is lost, later each time, and frames are
 * pulled: nothing is asked for that has not been drawn, so that nothing can pile up.
 */

import { readFrame } from "./messages.js";

/** @typedef {import("./messages.js").Frame} Frame */
/** @typedef {import("./messages.js").State} State */
/** @typedef {import("./messages.js").Welcome} Welcome */

const FIRST_WAIT_MS = 500;
const LONGEST_WAIT_MS = 10_000;
/** A frame on its way for longer than this is not waited for: a second one is asked for. */
const SLOW_MS = 12;
const MOST_IN_FLIGHT = 2;

/**
 * What is told about the connection.
 * @typedef {object} Listener
 * @property {(welcome: Welcome) => void} welcomed
 * @property {(state: State) => void} told
 * @property {(frame: Frame) => void} framed
 * @property {(why: string) => void} refused
 * @property {(again: boolean) => void} lost whether it is tried again
 */

export class Connection {
  /** @type {WebSocket | null} */
  #socket = null;
  #wait = FIRST_WAIT_MS;
  #welcomed = false;
  #refused = false;
  /** @type {number[]} */
  #asked = []; // when each frame on its way was asked for
  #slow = true; // at first two are asked for

  /**
   * @param {string} token
   * @param {Listener} listener
   */
  constructor(token, listener) {
    this.token = token;
    this.listener = listener;
  }

  /** Whether the server has said welcome, and can be asked. */
  get open() {
    return this.#welcomed;
  }

  /** Begins to talk. */
  begin() {
    const scheme = location.protocol === "https:" ? "wss:" : "ws:";
    const socket = new WebSocket(`${scheme}//${location.host}/live`);
    socket.binaryType = "arraybuffer";
    this.#socket = socket;
    this.#refused = false;
    socket.addEventListener("open", () => this.#send({ ask: "hello", token: this.token }));
    socket.addEventListener("message", (event) => this.#take(event.data));
    socket.addEventListener("close", () => this.#end());
  }

  /**
   * Asks for something; false if no server is there to ask.
   * @param {{ask: string} & Record<string, unknown>} request
   */
  ask(request) {
    if (this.#welcomed) this.#send(request);
    return this.#welcomed;
  }

  /**
   * Asks for as many frames as keep the drawing going.
   * @param {() => Record<string, unknown>} wanted what to ask, for each
   * @param {number} most how many may be on their way
   */
  pull(wanted, most = this.#slow ? MOST_IN_FLIGHT : 1) {
    while (this.#welcomed && this.#asked.length < most) {
      this.#asked.push(performance.now());
      this.#send({ ask: "next", ...wanted() });
    }
  }

  /** @param {object} request */
  #send(request) {
    if (this.#socket?.readyState === WebSocket.OPEN) this.#socket.send(JSON.stringify(request));
  }

  /** @param {string | ArrayBuffer} received */
  #take(received) {
    if (typeof received !== "string") {
      const frame = readFrame(received);
      const asked = this.#asked.shift();
      if (frame === null) return this.listener.refused("a frame could not be read; load the page again");
      if (asked !== undefined) this.#slow = performance.now() - asked > SLOW_MS;
      return this.listener.framed(frame);
    }
    const said = JSON.parse(received);
    if (said.tell === "welcome") {
      this.#welcomed = true;
      this.#wait = FIRST_WAIT_MS;
      this.#asked = [];
      this.#slow = true;
      this.listener.welcomed(said);
    } else if (said.tell === "state") {
      this.listener.told(said);
    } else if (said.tell === "refused") {
      this.#refused = true;
      this.listener.refused(said.why);
    }
  }

  #end() {
    // A page that was not let in is told why, and asks again only when a person wants it.
    const again = this.#welcomed || !this.#refused;
    this.#welcomed = false;
    this.#socket = null;
    this.listener.lost(again);
    if (!again) return;
    setTimeout(() => this.begin(), this.#wait);
    this.#wait = Math.min(2 * this.#wait, LONGEST_WAIT_MS);
  }
}
