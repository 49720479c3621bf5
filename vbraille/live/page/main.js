/**
 * The live view. A frame is drawn when the browser draws, the next is asked for when it is drawn, and
 * what is asked of the knobs goes out at the same time: once for each frame.
 */

import { Cards, Signals } from "./answers.js";
import { sayWhere } from "./braille.js";
import { Connection } from "./connection.js";
import { byId, write } from "./elements.js";
import { Hand } from "./hand.js";
import { Knobs } from "./knobs.js";
import { Playback } from "./playback.js";
import { Sheet } from "./sheet.js";
import { Skin } from "./skin.js";
import { Telling, tables } from "./telling.js";

const READ_MS = 100; // how often numbers change: people cannot read them faster
const CALM_MS = 1000; // how often anything changes where motion is to be reduced
const OWN_MS = 400; // for so long after the hand was moved here, the drawing follows it all the same
const NOTICE_MS = 20_000;

let welcome = null;
let state = null;
let fresh = null; // a state that is told, and not yet shown
let frame = null;
let queue = []; // frames that are not yet drawn
let drawn = 0;
let drawnAt = -Infinity;
let reading = 0; // timer until the numbers are read anew
let readAt = -Infinity;
let told = 0; // pictures drawn before the numbers were read last
let frozen = false;
let woken = false;
let noticed = 0;
let lostBefore = false;
const still = matchMedia("(prefers-reduced-motion: reduce)");

const connection = new Connection(token(), {
  welcomed(said) {
    welcome = said;
    notice(lostBefore ? "Connected again." : "", lostBefore);
    lostBefore = false;
    queue = [];
    byId("again").hidden = true;
    playback.begin(said);
    fresh ??= state;
    wake();
  },
  told(said) {
    fresh = said;
    wake();
  },
  framed(received) {
    queue.push(received);
    wake();
  },
  refused(why) {
    notice(why.charAt(0).toUpperCase() + why.slice(1) + (/[.!?]$/.test(why) ? "" : "."), connection.open);
  },
  lost(again) {
    byId("again").hidden = again;
    // It is said once, not at every attempt.
    if (again && !lostBefore) notice("The connection to vbraille is lost. It is tried again every few seconds.");
    lostBefore = again;
    fresh ??= state;
    wake();
  },
});
const ask = (request) => connection.ask(request);
const sheet = new Sheet(byId("sheet"));
const skin = new Skin();
const telling = new Telling();
const signals = new Signals();
const cards = new Cards(ask);
const knobs = new Knobs(ask, wake);
const hand = new Hand(sheet, ask, wake);
const playback = new Playback(wake);

/** The token of the address; it stays for this tab, and goes out of the address bar. */
function token() {
  const given = decodeURIComponent(location.hash.slice(1));
  // Only what looks like a token: the page has places of its own, such as #page.
  if (given && !byId(given)) {
    sessionStorage.setItem("vbraille-token", given);
    history.replaceState(null, "", location.pathname);
  }
  return sessionStorage.getItem("vbraille-token") ?? "";
}

/** Says something about the connection or a refusal; what is brief goes away by itself. */
function notice(words, brief = false) {
  clearTimeout(noticed);
  write(byId("notice"), words);
  if (brief && words) noticed = setTimeout(() => write(byId("notice"), ""), NOTICE_MS);
}

/** Has the browser call `beat` when it draws next. */
function wake() {
  if (woken) return;
  woken = true;
  requestAnimationFrame(beat);
}

/** What is done once for each picture of the browser. */
function beat(now) {
  woken = false;
  knobs.send();
  hand.send();
  if (fresh) show();
  if (playback.on) {
    playback.advance(now);
    if (playback.playing) wake();
  }
  if (frozen) return;
  const calm = still.matches && performance.now() - hand.moved > OWN_MS && !(playback.on && !playback.playing);
  if (queue.length && calm && now - drawnAt < CALM_MS) {
    setTimeout(wake, CALM_MS - (now - drawnAt));
    return;
  }
  if (queue.length && state) draw(now);
  if (!playback.on) connection.pull(() => ({}));
  else if (playback.wanted) connection.pull(() => playback.request(), 1);
}

/** Shows a new state. */
function show() {
  [state, fresh] = [fresh, null];
  const { open } = connection;
  const steers = Boolean(open && welcome?.steers && !playback.on && !state.done);
  document.body.classList.toggle("blind", state.blind);
  byId("touch").hidden = state.blind;
  telling.show(state);
  sheet.show(state);
  skin.show(state);
  knobs.show(state, steers, whyNot(open));
  hand.show(state, steers);
  signals.show(state);
  cards.show(state, steers);
  if (state.array) playback.tick(state.array.rate_hz);
  write(byId("kind"), playback.on ? "· a recording" : open ? (steers ? "· may steer" : "· watching") : "· not connected");
  write(byId("page-note"), pageNote());
  if (frame) skin.move(state, frame);
}

/** Reason why nothing can be turned here; empty if it can. */
function whyNot(open) {
  if (!open) return "Nothing can be turned without a connection.";
  if (playback.on) return "A recording is shown: nothing can be turned in it.";
  if (state.done) return "Reading is over.";
  if (!welcome.steers) return "This page watches. To steer, open the address with a token that vbraille says when it begins.";
  return state.knobs.length || state.commands.length ? "" : "Nothing may be turned here.";
}

function pageNote() {
  if (state.blind) return "Hidden: where the hand is, and nothing of what it feels.";
  if (!hand.can) return "To scale; the rulers are in mm.";
  const along = state.array.height_mm > 0 ? "" : " along the line";
  return `To scale, in mm. Drag the array${along}, or press where it is to go; arrow keys move it by 0.5 mm, with Shift by 5 mm; Escape lets it go.`;
}

function draw(now) {
  frame = queue[queue.length - 1];
  queue = [];
  sheet.move(state, frame);
  skin.move(state, frame);
  hand.see(frame);
  if (playback.on) playback.show();
  drawn += 1;
  drawnAt = now;
  const left = readAt + READ_MS - performance.now();
  if (left <= 0 || still.matches || (playback.on && !playback.playing)) read();
  else if (!reading) reading = setTimeout(read, left);
}

/** Tells what is drawn in words and numbers. */
function read() {
  clearTimeout(reading);
  reading = 0;
  if (!state || !frame) return;
  readAt = performance.now();
  told = drawn;
  telling.read(state, frame);
  signals.read(frame);
}

byId("say").addEventListener("click", () => {
  write(byId("where"), "");
  const words = state ? sayWhere(state, frame) : "Nothing is shown yet.";
  setTimeout(() => write(byId("where"), words), 30); // so that the same words are said again
});
byId("freeze").addEventListener("click", () => {
  frozen = !frozen;
  byId("freeze").setAttribute("aria-pressed", String(frozen));
  read(); // the numbers are those of the picture
  wake();
});
byId("again").addEventListener("click", () => {
  byId("again").hidden = true;
  notice("Connecting.");
  connection.begin();
});
const take = () => state && byId("tables").replaceChildren(...tables(state, frame));
byId("take").addEventListener("click", take);
byId("words").addEventListener("toggle", take);
still.addEventListener("change", wake);
connection.begin();

/** For tests: what was drawn and told last. */
Object.defineProperty(window, "vbraille", { get: () => ({ drawn, told, state, last: frame && { ...frame, deflections: [...frame.deflections] } }) });
