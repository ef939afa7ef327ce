// Drawing of curves: lines and bands, points and bars, steps; each with a second cue besides its colour.

import { css, curveColour, curveDash, look, parse } from "./colour.js";

const MOST_POINTS = 40; // at most this many measured values are points with bars, more are a line with a band
const FAINT = 0.45; // opacity of averages of a box that is not yet in equilibrium
const MOST_CROSSINGS = 25; // of its own range; a curve with more is drawn thinner

export function markerSvg(index, colour) {
  return [
    `<circle cx="12" cy="5" r="3.2" fill="${colour}"/>`,
    `<rect x="9" y="2" width="6" height="6" fill="${colour}"/>`,
    `<path d="M12 1.4 16 8.2H8Z" fill="${colour}"/>`,
    `<path d="M12 1 16 5 12 9 8 5Z" fill="${colour}"/>`,
  ][index % 4];
}

export function drawCurve(context, curve, { spot, unit, across, colour, several, floor }) {
  const { x, y, error, role, index, from } = curve;
  context.strokeStyle = context.fillStyle = curve.faint ? css(parse(colour), FAINT) : colour;
  context.lineJoin = "round";
  if (curve.steps) return drawSteps(context, curve, spot, unit, floor);
  const points = x.map((value, place) => spot(value, y[place]));
  const measured = role === "data" && x.length <= MOST_POINTS;
  if (error) drawErrors(context, curve, spot, unit, across, measured);
  context.lineWidth = unit * (role === "reference" ? 5 : role === "data" ? 1.8 * slender(curve, across) : 2);
  context.globalAlpha = measured && error ? 0.45 : 1;
  context.setLineDash(curveDash(role, index).map((part) => part * unit));
  context.beginPath();
  let down = false;
  for (const [px, py] of from ? [spot(...from), ...points] : points) {
    const known = Number.isFinite(px) && Number.isFinite(py);
    if (known && down) context.lineTo(px, py);
    else if (known) context.moveTo(px, py);
    down = known;
  }
  context.stroke();
  context.globalAlpha = 1;
  context.setLineDash([]);
  const every = measured ? 1 : Math.max(1, Math.floor(points.length / 8));
  if (!(measured || several)) return undefined;
  points.forEach((point, place) => {
    if ((place - Math.floor(every / 2)) % every !== 0 || !point.every(Number.isFinite)) return;
    mark(context, point, index, unit);
    if (measured && error && !Number.isFinite(error[place])) hollow(context, unit);
  });
  return undefined;
}

// A curve that crosses its own range very often is drawn thinner, so that its scatter stays readable.
function slender({ x, y }, across) {
  const values = (across ? x : y).filter(Number.isFinite);
  let way = 0, low = Infinity, high = -Infinity;
  values.forEach((value, place) => {
    way += place ? Math.abs(value - values[place - 1]) : 0;
    [low, high] = [Math.min(low, value), Math.max(high, value)];
  });
  return high > low ? Math.min(1, Math.max(0.5, MOST_CROSSINGS * (high - low) / way)) : 1;
}

function drawErrors(context, { x, y, error, role }, spot, unit, across, bars) {
  const ends = x.map((value, place) => [-1, 1].map((sign) =>
    (across ? spot(value + sign * error[place], y[place]) : spot(value, y[place] + sign * error[place]))));
  const known = ends.filter((pair) => pair.flat().every(Number.isFinite));
  context.lineWidth = unit;
  context.beginPath();
  if (bars) {
    for (const [[x0, y0], [x1, y1]] of known) {
      context.moveTo(x0, y0);
      context.lineTo(x1, y1);
    }
    context.stroke();
  } else if (known.length > 1) {
    known.forEach(([low], place) => (place ? context.lineTo(...low) : context.moveTo(...low)));
    known.toReversed().forEach(([, high]) => context.lineTo(...high));
    context.globalAlpha = role === "data" ? 0.28 : 0.13;
    context.fill();
    context.globalAlpha = 1;
  }
}

// Shade the areas between a curve and zero: to the right as CAPE, to the left as CIN.
export function drawAreas(context, { x, y }, spot, { left, top, width, height }) {
  const points = y.map((value, place) => spot(x[place], value)).filter((point) => point.every(Number.isFinite));
  if (points.length < 2) return;
  const [zero] = spot(0, y[0]);
  [[zero, left + width - zero], [left, zero - left]].forEach(([from, wide], index) => {
    context.save();
    context.beginPath();
    context.rect(from, top, Math.max(wide, 0), height);
    context.clip();
    context.beginPath();
    for (const [px, py] of [[zero, points[0][1]], ...points, [zero, points.at(-1)[1]]]) context.lineTo(px, py);
    context.fillStyle = curveColour("reference", index);
    context.globalAlpha = 0.35;
    context.fill();
    context.restore();
  });
}

// Draw a histogram as steps between the bounds of its bins.
function drawSteps(context, { x, y, error }, spot, unit, floor) {
  if (x.length < 2) return;
  const bounds = x.map((value, place) => (place ? (x[place - 1] + value) / 2 : value - (x[1] - value) / 2));
  bounds.push(2 * x.at(-1) - bounds.at(-1));
  context.beginPath();
  context.moveTo(spot(bounds[0], 0)[0], floor);
  x.forEach((_, place) => {
    const height = spot(x[place], y[place])[1];
    context.lineTo(spot(bounds[place], 0)[0], height);
    context.lineTo(spot(bounds[place + 1], 0)[0], height);
  });
  context.lineTo(spot(bounds.at(-1), 0)[0], floor);
  context.globalAlpha = 0.22;
  context.fill();
  context.globalAlpha = 1;
  context.lineWidth = 1.6 * unit;
  context.stroke();
  if (error) drawErrors(context, { x, y, error, role: "data" }, spot, unit, false, true);
}

// Draw a point whose error is not known, as in a layer that was seldom visited.
export function hollow(context, unit) {
  context.save();
  context.fillStyle = look().card;
  context.fill();
  context.lineWidth = 1.4 * unit;
  context.stroke();
  context.restore();
}

export function mark(context, [x, y], index, unit) {
  const size = 3 * unit;
  context.beginPath();
  if (index % 4 === 0) context.arc(x, y, size, 0, 7);
  else if (index % 4 === 1) context.rect(x - size, y - size, 2 * size, 2 * size);
  else if (index % 4 === 2) {
    context.moveTo(x, y - 1.2 * size);
    context.lineTo(x + 1.2 * size, y + size);
    context.lineTo(x - 1.2 * size, y + size);
  } else {
    context.moveTo(x, y - 1.4 * size);
    context.lineTo(x + 1.4 * size, y);
    context.lineTo(x, y + 1.4 * size);
    context.lineTo(x - 1.4 * size, y);
  }
  context.fill();
}
