// The parts of a skew-T: inclined isotherms, adiabats, and shaded energies.

import { curveColour, look } from "./colour.js";

const SLANT = 32; // K to the right for each factor e of pressure
const KAPPA = 2 / 7, ZERO = 273.15;

// The horizontal coordinate of the diagram, which is the temperature at its lower end.
export const slanted = (temperature, pressure, foot) => temperature + SLANT * Math.log(foot / pressure);

// Saturation vapour pressure over water [hPa] (Bolton 1980), for the background lines only.
const saturation = (celsius) => 6.112 * Math.exp(17.67 * celsius / (celsius + 243.5));

function moistSlope(celsius, pressure) {
  const kelvin = celsius + ZERO, vapour = Math.min(saturation(celsius), 0.9 * pressure);
  const mixing = 0.622 * vapour / (pressure - vapour);
  const latent = 2.501e6;
  return (287 * kelvin + latent * mixing) / (1004 + latent * latent * mixing * 0.622 / (287 * kelvin * kelvin));
}

// The background lines: isotherms, dry and moist adiabats, each a list of (temperature, pressure).
export function background(foot, top) {
  const pressures = Array.from({ length: 41 }, (_, step) => foot * (top / foot) ** (step / 40));
  const lines = [];
  for (let celsius = -140; celsius <= 60; celsius += 10) {
    lines.push({ kind: "isotherm", points: [[celsius, foot], [celsius, top]], strong: celsius === 0 });
  }
  for (let theta = 220; theta <= 520; theta += 20) {
    lines.push({ kind: "dry", points: pressures.map((p) => [theta * (p / 1000) ** KAPPA - ZERO, p]) });
  }
  for (let start = -20; start <= 40; start += 10) {
    const points = [];
    let celsius = start, at = 1000;
    for (const p of pressures) {
      const steps = Math.max(1, Math.ceil(Math.abs(Math.log(p / at)) / 0.02));
      const step = Math.log(p / at) / steps;
      for (let k = 0; k < steps; k += 1) {
        const half = celsius + 0.5 * step * moistSlope(celsius, at);
        celsius += step * moistSlope(half, at * Math.exp(0.5 * step));
        at *= Math.exp(step);
      }
      points.push([celsius, p]);
    }
    lines.push({ kind: "moist", points });
  }
  return lines;
}

// CAPE and CIN: polygons between parcel and environment where the parcel is warmer (CAPE) or cooler (CIN).
export function energies(panel, curves) {
  const parcel = curves.find(({ role }) => role === "data"), around = curves.find(({ role }) => role === "environment");
  const { LFC: lfc, EL: el } = panel.marks;
  if (!parcel || !around || !lfc) return [];
  const lowest = Math.max(...parcel.y.filter(Number.isFinite)), highest = Math.min(...parcel.y.filter(Number.isFinite));
  const between = (name, from, to, sign) => {
    const levels = Array.from({ length: 61 }, (_, step) => from * (to / from) ** (step / 60));
    const pairs = levels.map((p) => [p, at(parcel, p), at(around, p)]).filter(([, warm, cool]) => sign * (warm - cool) > 0);
    return { name, pairs };
  };
  return [between("CAPE", lfc, el ?? highest, 1), between("CIN", lowest, lfc, -1)].filter(({ pairs }) => pairs.length > 1);
}

// The temperature of a curve at a pressure.
function at({ x, y }, pressure) {
  for (let index = 1; index < y.length; index += 1) {
    const [low, high] = [y[index - 1], y[index]];
    if ((low - pressure) * (high - pressure) <= 0 && low !== high) {
      return x[index - 1] + (x[index] - x[index - 1]) * Math.log(pressure / low) / Math.log(high / low);
    }
  }
  return NaN;
}

// Draw background and energies; `spot` gives the pixel of a temperature and a pressure.
export function drawSkewt(context, panel, curves, foot, top, spot, unit) {
  const path = (points) => {
    context.beginPath();
    points.forEach(([t, p], index) => {
      const [x, y] = spot(t, p);
      if (index) context.lineTo(x, y); else context.moveTo(x, y);
    });
  };
  for (const { kind, points, strong } of background(foot, top)) {
    path(points);
    context.strokeStyle = strong ? look().faint : look().grid;
    context.lineWidth = unit * (strong ? 0.8 : 1);
    context.setLineDash(kind === "moist" ? [5 * unit, 3 * unit] : kind === "isotherm" ? [] : [1 * unit, 0]);
    context.stroke();
  }
  context.setLineDash([]);
  for (const { name, pairs } of energies(panel, curves)) {
    path([...pairs.map(([p, warm]) => [warm, p]), ...pairs.toReversed().map(([p, , cool]) => [cool, p])]);
    context.fillStyle = curveColour("reference", name === "CAPE" ? 0 : 1);
    context.globalAlpha = 0.35;
    context.fill();
    context.globalAlpha = 1;
    const [p, warm, cool] = pairs[Math.floor(pairs.length / 2)];
    const [x, y] = spot((warm + cool) / 2, p);
    if (name === "CAPE") {
      context.fillStyle = look().ink;
      context.textAlign = "center";
      context.fillText(name, x, y);
    }
  }
}
