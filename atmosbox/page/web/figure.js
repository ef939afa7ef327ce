// Numbers as text: their digits, their units, and the ticks of an axis.

import { numbers } from "./words.js";

const SPELLED = { degC: "°C", percent: "%", um: "µm", us: "µs", 1: "" };
const RAISED = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };

// A length in pixels of a screen of usual size; more pixels on a large screen, which is seen from farther away.
export const scaled = (pixels) => pixels / 16 * parseFloat(getComputedStyle(document.documentElement).fontSize);

const raised = (text) => [...text].map((sign) => RAISED[sign]).join("");

// A unit as files write it, "m s-1", as it is printed.
export const spelled = (unit) =>
  (unit ?? "").split(" ").map((word) => SPELLED[word] ?? word.replace(/-?\d+$/, raised)).join(" ").trim();

export function figure(value, digits = 3) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) {
    const power = Math.floor(Math.log10(size));
    return `${plain((value / 10 ** power).toPrecision(2))} × 10${raised(String(power))}`;
  }
  const whole = Math.floor(Math.log10(size)) + 1;
  return plain(value.toFixed(Math.max(0, digits - whole)));
}

export const withUnit = (value, unit, digits) => [figure(value, digits), spelled(unit)].filter(Boolean).join(" ");

// Round numbers from low to high, about as many as wanted.
export function ticks(low, high, about) {
  if (!(high > low)) return [low];
  const raw = (high - low) / Math.max(about, 1);
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 2.5, 5, 10].find((each) => each * power >= raw * 0.999) * power;
  const found = [];
  for (let index = Math.ceil(low / step - 1e-9); index * step <= high + 1e-9 * step; index += 1) found.push(index * step);
  return found;
}

// Ticks of a logarithmic axis: powers of ten, with 2 and 5 between them where there is room; round numbers on a short one.
export function logTicks(low, high, about) {
  const decades = Math.log10(high / low);
  if (decades < 1) return ticks(low, high, about).filter((value) => value > 0);
  const parts = decades * 3 <= about * 1.4 ? [1, 2, 5] : [1];
  const every = parts.length === 1 ? Math.max(1, Math.ceil(decades / Math.max(about, 1))) : 1;
  const found = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.ceil(Math.log10(high)); power += every) {
    for (const part of parts) {
      const value = part * 10 ** power;
      if (value >= low * 0.9999 && value <= high * 1.0001) found.push(value);
    }
  }
  return found;
}

// The texts of the ticks of an axis: all with the same decimals, large or small ones with one common power of ten.
export function tickTexts(values) {
  const largest = Math.max(...values.map(Math.abs));
  if (!(largest > 0)) return { texts: values.map(() => "0"), power: 0 };
  const power = largest >= 1e5 || largest < 1e-2 ? Math.floor(Math.log10(largest)) : 0;
  const texts = values.map((value) => round(value / 10 ** power));
  return { texts, power };
}

// A round number without trailing zeros.
export const round = (value) => plain(String(Number(value.toPrecision(6))));

export const powerText = (power) => (power ? `10${raised(String(power))}` : "");

const plain = (text) => numbers(text.replace("-", "−"));
