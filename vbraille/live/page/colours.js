/**
 * Colours of what is measured. Deflection goes evenly from pale to deep (on a dark ground from dim to
 * bright), so that the order stays in every colour blindness and in grey. Strain has two hues of that
 * kind, and a shape: what is stretched stands up and is filled, what is pressed hangs hollow.
 */

const LIGHT = {
  ramp: ["#f3eddc", "#acc4bb", "#6796ad", "#305e8a", "#0d1b3c"],
  stretch: "#a8480f",
  press: "#1d5f9e",
};
const DARK = {
  ramp: ["#33302b", "#3b5667", "#5388a0", "#93c2bd", "#f7f1d8"],
  stretch: "#f0a060",
  press: "#86bdf2",
};

/** Steps between rest and full swing that have a colour of their own. */
export const STEPS = 20;

const channels = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));

/** The colour of each step, evenly along the stops. */
function ramp(stops) {
  return Array.from({ length: STEPS + 1 }, (_, step) => {
    const place = (step / STEPS) * (stops.length - 1);
    const at = Math.min(Math.floor(place), stops.length - 2);
    const [from, to] = [channels(stops[at]), channels(stops[at + 1])];
    return `rgb(${from.map((value, n) => Math.round(value + (to[n] - value) * (place - at))).join()})`;
  });
}

const dark = matchMedia("(prefers-color-scheme: dark)");
const [lightRamp, darkRamp] = [ramp(LIGHT.ramp), ramp(DARK.ramp)];

/** The colours of now, and the steps from rest to full swing. */
export const colours = () => (dark.matches ? DARK : LIGHT);
export const steps = () => (dark.matches ? darkRamp : lightRamp);

/** Calls when light becomes dark, or dark light. */
export const onScheme = (then) => dark.addEventListener("change", then);

/** The step of a deflection, 0 to STEPS. */
export const stepOf = (deflection) => Math.round(Math.min(Math.max(deflection, 0), 1) * STEPS);
