// The atmosphere around a lifted parcel: ground or mountains, the parcel at its present place, cloud, rain and gauges.

import { curveColour, look, theme } from "./colour.js";
import { numbers, word } from "./words.js";

const GAP = 0.07; // height of the parcel above the mountains in the picture, in heights of the picture
const COLOURS = {
  light: { low: "#e4f0f8", high: "#9cc4e2", ground: "#8aa37b", rock: "#9a8f80", cloud: "#ffffff", rim: "#8c97a3", clear: "#cfe3f1" },
  dark: { low: "#3b5468", high: "#1d3247", ground: "#4d6342", rock: "#6b6256", cloud: "#dfe6ee", rim: "#8c97a3", clear: "#4d7390" },
};

// There is no hygrometer where this many molecules, or fewer, would saturate the air: their number scatters too much.
const FEW = 50;

// The path of the parcel as a curve of its graph: heights [km] over time, and the variables measured along the path. It
// begins on the ground if the graph says so, and a planned path is known before the parcel moves.
export function wayOf({ lines: [line], start, along }, measured) {
  const time = measured.get("elapsed_time") ?? [], height = measured.get("parcel_height") ?? [];
  if (!height.length && !line.planned) return [];
  const [temperature, pressure, liquid, haze, rain, humid, base, vapour] = along.map((name) => measured.get(name) ?? []);
  const humidity = humid.map((share, frame) => (vapour[frame] < FEW * share ? NaN : share));
  const y = height.map((value) => (value === null ? NaN : value / 1000));
  const moment = measured.get("moment") ?? time;
  const way = { temperature, pressure, liquid, haze, rain, humidity, moment, planned: line.planned ?? null, base: base[0] ?? Infinity };
  const curve = { label: line.label, role: "data", index: 0, error: null };
  way.crosses = descends(line.planned?.y ?? y);
  if (!start?.length) return [{ ...curve, x: time, y, way }];
  const first = { temperature: start[0] + 273.15, pressure: 100 * start[1], liquid: 0, haze: Infinity, rain: 0, humidity: NaN, moment: 0 };
  for (const [name, value] of Object.entries(first)) if (way[name].length || !height.length) way[name] = [value, ...way[name]];
  return [{ ...curve, x: [0, ...time], y: [line.planned?.y[0] ?? 0, ...y], way }];
}

// Whether a path leads over mountains: whether it goes down again.
function descends(heights) {
  const highest = heights.reduce((most, value, place) => (value > heights[most] ? place : most), 0);
  return heights[highest] - Math.min(...heights.slice(highest)) > 0.1 * (Math.max(...heights) - Math.min(...heights));
}

// Draw the paths of all runs up to a time into a box of the canvas; `up` converts a height to a pixel.
export function drawAtmosphere(context, box, curves, time, up, unit) {
  const colours = COLOURS[theme()];
  const sky = context.createLinearGradient(0, box.top + box.height, 0, box.top);
  sky.addColorStop(0, colours.low);
  sky.addColorStop(1, colours.high);
  context.fillStyle = sky;
  context.fillRect(box.left, box.top, box.width, box.height);
  const ways = curves.map((curve, number) => placed(curve, number, curves.length, time, box));
  for (const way of ways) drawCloud(context, box, way, up, unit, colours);
  if (ways.length) drawGround(context, box, ways[0], up, colours);
  for (const way of ways) drawRain(context, box, way, up, unit);
  ways.forEach((way, number) => {
    drawParcel(context, way, up, unit, curveColour("data", number), colours);
    drawGauges(context, box, way, number, unit);
  });
}

// A path with its positions in the picture: vertical, each run in its own part, or from end to end over mountains.
function placed({ x, y, way }, number, runs, time, box) {
  const ground = way.planned ?? { moment: way.moment, y };
  const { crosses } = way, wide = box.width / runs, [first, last] = [ground.moment[0], ground.moment.at(-1)];
  const now = time === null ? x.length - 1 : Math.max(0, x.findLastIndex((each) => each <= time));
  const at = (moment) => box.left + box.width * (0.03 + 0.94 * (moment - first) / (last - first || 1));
  const across = (place) => (crosses ? at(way.moment[place]) : box.left + wide * (number + 0.3));
  // more liquid than chance puts together without a cloud, or rain that falls from it
  const cloudy = (place) => way.liquid[place] > way.haze[place] || way.rain[place] > way.rain[place - 1];
  const seen = y.findIndex((_, place) => place <= now && cloudy(place));
  // a cloud begins where the run has measured its base, or where liquid was first seen to be one
  const base = seen < 0 ? null : y[way.base <= Math.max(...way.pressure) ? way.pressure.findIndex((value) => value <= way.base) : seen];
  return { y, ...way, across, cloudy, now, wide, base, slope: ground.y.map((height, place) => [at(ground.moment[place]), height]) };
}

function drawGround(context, box, { crosses, slope }, up, colours) {
  const bottom = box.top + box.height, right = box.left + box.width, below = crosses ? GAP * box.height : 0;
  context.fillStyle = crosses ? colours.rock : colours.ground;
  context.beginPath();
  context.moveTo(box.left, bottom);
  context.lineTo(box.left, up(crosses ? slope[0][1] : 0) + below);
  if (crosses) for (const [x, height] of slope) context.lineTo(x, up(height) + below);
  context.lineTo(right, up(crosses ? slope.at(-1)[1] : 0) + below);
  context.lineTo(right, bottom);
  context.fill();
}

// Draw first the rims of all puffs, then their insides, so that a cloud has one outline.
function drawCloud(context, box, { y, now, liquid, cloudy, crosses, across, wide, base }, up, unit, colours) {
  const places = Array.from({ length: now + 1 }, (_, place) => place).filter(cloudy);
  if (!places.length || (!crosses && y[now] <= base)) return;
  const puffs = [];
  context.save();
  if (crosses) {
    const most = Math.max(...places.map((place) => liquid[place]));
    for (const place of places) puffs.push([across(place), up(y[place]), 0.12 * box.height * Math.sqrt(Math.max(liquid[place] / most, 0.25))]);
  } else {
    const low = up(base), top = up(y[now]);
    const rows = Math.max(2, Math.round((low - top) / (9 * unit))), broad = Math.min(0.24 * wide, 110 * unit);
    const columns = Math.round(broad / (6 * unit));
    for (let row = 0; row < rows; row += 1) {
      for (let column = 0; column < columns; column += 1) {
        const jitter = Math.abs(Math.sin(12.9898 * row + 78.233 * column) * 43758.5453) % 1; // the same in every picture
        const half = broad * (1 - 0.33 * row / rows) * (2 * column / (columns - 1) - 1);
        puffs.push([across(now) + half, low + (top - low) * row / (rows - 1), (9 + 6 * jitter) * unit]);
      }
    }
    context.beginPath();
    context.rect(box.left, box.top, box.width, low - box.top);
    context.clip();
  }
  for (const [colour, wider] of [[colours.rim, 1.5 * unit], [colours.cloud, 0]]) {
    context.fillStyle = colour;
    for (const [x, height, radius] of puffs) disc(context, x, height, radius + wider);
  }
  context.restore();
}

function drawRain(context, box, { y, now, rain, crosses, across, wide, base }, up, unit) {
  const last = rain.at(-1) ?? 0;
  if (!(rain[now] > 0)) return;
  context.strokeStyle = look().liquid;
  context.lineWidth = 1.6 * unit;
  context.beginPath();
  if (crosses) {
    for (let place = 1; place <= now; place += 1) {
      if (rain[place] - rain[place - 1] < 0.02 * last) continue;
      context.moveTo(across(place), up(y[place]));
      context.lineTo(across(place) - 3 * unit, up(y[place]) + GAP * box.height);
    }
  } else {
    const high = up(base === null ? y[now] : Math.min(base, y[now]));
    for (let streak = -4; streak <= 4; streak += 1) {
      const x = across(now) + 0.05 * streak * wide;
      context.moveTo(x, high);
      context.lineTo(x - 3 * unit, up(0));
    }
  }
  context.stroke();
}

// Draw the parcel; its size follows from its temperature and its pressure.
function drawParcel(context, { y, now, temperature, pressure, cloudy, across }, up, unit, rim, colours) {
  const grown = Math.cbrt((temperature[now] / temperature[0]) * (pressure[0] / pressure[now])) || 1;
  context.fillStyle = rim;
  disc(context, across(now), up(y[now]), (10 * grown + 2) * unit);
  context.fillStyle = cloudy(now) ? colours.rim : colours.clear;
  disc(context, across(now), up(y[now]), 10 * grown * unit);
}

// Draw height, thermometer, barometer and, in a scene with water, hygrometer, with digits readable from the last row:
// one below the other, or side by side above mountains.
function drawGauges(context, box, { y, now, temperature, pressure, humidity, crosses, wide }, number, unit) {
  const texts = [
    [y[now], (height) => `${height.toFixed(1)} km`, look().ink],
    [temperature[now], (kelvin) => `${(kelvin - 273.15).toFixed(0)} °C`, look().warm],
    [pressure[now], (pascal) => `${(pascal / 100).toFixed(0)} hPa`, look().ink],
    [humidity[now], (share) => word("humid", { number: (100 * share).toFixed(0) }), look().liquid],
  ].filter(([value]) => Number.isFinite(value)).map(([value, words, colour]) => [numbers(words(value).replace("-", "−")), colour]);
  const size = (crosses ? Math.min(22, 0.045 * wide / unit) : Math.min(24, 0.13 * wide / unit, 0.17 * box.height / unit)) * unit;
  context.save();
  context.font = `600 ${size}px system-ui, -apple-system, 'Segoe UI', Roboto, sans-serif`;
  context.textAlign = crosses ? "left" : "right";
  context.lineJoin = "round";
  context.lineWidth = 4 * unit;
  context.strokeStyle = look().card;
  let x = crosses ? box.left + 10 * unit : box.left + wide * (number + 1) - 8 * unit;
  texts.forEach(([text, colour], place) => {
    const base = box.top + ((crosses ? number : place) + 1) * 1.25 * size;
    context.strokeText(text, x, base);
    context.fillStyle = colour;
    context.fillText(text, x, base);
    if (crosses) x += context.measureText(text).width + size;
  });
  context.restore();
}

function disc(context, x, y, radius) {
  context.beginPath();
  context.arc(x, y, radius, 0, 7);
  context.fill();
}
