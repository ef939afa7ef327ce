// The distribution of the molecules' speeds in a frame, and Maxwell's distribution for the same kinetic energy.

import { word } from "./words.js";

const BOLTZMANN = 1.380649e-23; // J/K
const BINS = 32;
const TOP = 255; // the stored speed at the top of the scale; molecules with it may be faster and are in no bin

// The panel of this graph.
export const speedPanel = (stage) => ({
  kind: "histogram",
  title: word(stage.particle === "disc" ? "speeds_now_discs" : "speeds_now"),
  note: "",
  across: false,
  sentences: [],
  x: { label: word("speed"), unit: stage.speed.unit, log: false, invert: false },
  y: { label: word(stage.particle === "disc" ? "share_of_discs" : "share_of_molecules"), unit: "%", log: false, invert: false },
});

// For each kind of molecule in a frame: the counts in bins, the number, and the sum of the squares of the speeds.
export function census(frame, stage) {
  const bins = new Float64Array(BINS), kinds = stage.species.map(() => ({ number: 0, squares: 0 }));
  let number = 0;
  for (let index = 0; index < frame.count; index += 1) {
    if (frame.state[index]) continue;
    const speed = frame.speed[index] / TOP * frame.fastest;
    const kind = kinds[stage.kind[index]];
    number += 1;
    kind.number += 1;
    kind.squares += speed * speed;
    if (frame.speed[index] < TOP) bins[Math.floor(frame.speed[index] * BINS / TOP)] += 1;
  }
  return { bins, kinds, number };
}

// Kinetic temperature [K], from the kinetic energy of the molecules that are drawn.
export function kineticTemperature({ kinds, number }, stage) {
  const energy = kinds.reduce((sum, { squares }, kind) => sum + 0.5 * stage.species[kind].mass * squares, 0);
  return number ? 2 * energy / ((stage.box.planar ? 2 : 3) * number * BOLTZMANN) : NaN;
}

// Maxwell's probability density of speeds [s/m] at a temperature; for a planar gas, that in two dimensions.
function maxwell(speed, mass, temperature, planar) {
  const slope = mass / (BOLTZMANN * temperature);
  const fall = Math.exp(-0.5 * slope * speed * speed);
  return planar ? slope * speed * fall : Math.sqrt(2 / Math.PI) * slope ** 1.5 * speed * speed * fall;
}

// The curves of the graph for a frame.
export function speedCurves(frame, stage) {
  const counted = census(frame, stage);
  const { bins, kinds, number } = counted;
  if (!number) return [];
  const width = frame.fastest / BINS, temperature = kineticTemperature(counted, stage);
  const middle = Array.from(bins, (_, bin) => (bin + 0.5) * width);
  const curves = [{
    label: `${stage.particle}s`, role: "data", index: 0, steps: true, error: null,
    x: middle, y: Array.from(bins, (count) => 100 * count / number),
  }];
  if (temperature > 0) {
    const fine = Array.from({ length: 97 }, (_, place) => place / 96 * frame.fastest);
    const share = (speed) => kinds.reduce((sum, kind, place) =>
      sum + kind.number / number * maxwell(speed, stage.species[place].mass, temperature, stage.box.planar), 0);
    curves.push({
      label: "Maxwell", role: "theory", index: 0, error: null,
      x: fine, y: fine.map((speed) => 100 * width * share(speed)),
    });
  }
  return curves;
}

// Upper end of a fixed axis: Maxwell's curve, with some margin, in about thirty frames of a film. Most steps of the
// histogram fit, too; those of molecules that all start with one speed would be far too high, and are cut off.
export function highestShare(frames, stage) {
  const every = Math.max(1, Math.floor(frames.length / 30));
  let highest = 0;
  for (let index = 0; index < frames.length; index += every) {
    for (const { y, role } of speedCurves(frames[index], stage)) {
      if (role === "theory") highest = Math.max(highest, ...y.map((share) => 1.5 * share));
    }
  }
  return highest;
}
