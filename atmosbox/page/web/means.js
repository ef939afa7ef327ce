// The mean of a measured curve over time, with its error, beside that of theory.

import { figure } from "./figure.js";
import { numbers, phrase, word } from "./words.js";

const BLOCKS = 16;

// Mean and standard error of values that depend on their neighbours: the scatter of the means of blocks.
function meanAndError(values) {
  const size = Math.floor(values.length / BLOCKS);
  const average = (part) => part.reduce((sum, value) => sum + value, 0) / part.length;
  const blocks = Array.from({ length: BLOCKS }, (_, block) => average(values.slice(block * size, (block + 1) * size)));
  const mean = average(blocks);
  return [mean, Math.sqrt(blocks.reduce((sum, each) => sum + (each - mean) ** 2, 0) / (BLOCKS * (BLOCKS - 1)))];
}

// A value with as many decimals as its error has.
function rounded(value, error) {
  const digits = Math.max(0, 1 - Math.floor(Math.log10(error)));
  const text = (number) => numbers(number.toFixed(Math.min(digits, 20)).replace("-", "−"));
  return `${text(value)} ± ${text(error)}`;
}

// For each measured curve that has a theory, a sentence: "its name = 24.6 ± 0.4 °C (theory 25.0)".
export function meansOf(curves, { since, changed }, unit) {
  const theories = curves.filter(({ role }) => role === "theory"), measured = curves.filter(({ role }) => role === "data");
  if (!theories.length) return [];
  return measured.flatMap((curve, place) => {
    const theory = theories[Math.min(place, theories.length - 1)], { x, y } = curve.whole ?? curve;
    const late = x.map((time, index) => index).filter((index) => x[index] >= since && Number.isFinite(y[index]));
    const expected = late.map((index) => theory.y[index]).filter(Number.isFinite);
    if (late.length < 2 * BLOCKS || expected.length < late.length) return [];
    const [mean, error] = meanAndError(late.map((index) => y[index]));
    if (!(error > 0)) return [];
    const told = expected.reduce((sum, value) => sum + value, 0) / expected.length;
    const known = figure(told, Math.max(3, Math.ceil(Math.log10(Math.abs(told) / error)) + 1));
    return [`${measured.length > 1 ? `${phrase(curve.label)} ` : ""}${word(changed ? "mean_since_change" : "mean_since_start")} (${word("theory_says", { value: known })}) = ${rounded(mean, error)} ${unit}`];
  });
}
