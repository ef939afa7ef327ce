// Colours: the scale of speeds, the kinds of molecules, the curves, and the temperatures of walls.

// viridis, which goes from dark to bright also in a grey print and for colour-blind readers.
const VIRIDIS = [
  "440154", "481a6c", "472f7d", "414487", "39568c", "31688e", "2a788e", "23888e",
  "1f988b", "22a884", "35b779", "54c568", "7ad151", "a5db36", "d2e21b", "fde725",
].map(parse);

// Okabe and Ito's colours; on a dark background the darker ones are made lighter.
const LOOKS = {
  light: {
    data: ["#0072b2", "#d55e00", "#b4568f", "#2f93cf"],
    theory: ["#1a1a1a", "#5a5a5a", "#808080"],
    environment: ["#009e73", "#b4568f"],
    reference: ["#e69f00", "#56b4e9"],
    prediction: ["#7a2fb0"],
    species: { "dry air": "#9ca8b6", water: "#1f86d6", molecule: "#8592a3", disc: "#8592a3", "light half": "#0072b2", "heavy half": "#d55e00", "gas from the left": "#0072b2", "gas from the right": "#e69f00" },
    background: "#f4f6f9", card: "#ffffff", edge: "#5d6b7c", metal: "#a9b4c0", liquid: "#2b8fdb", traced: "#d55e00",
    sky: "#a5cbe6", cloud: "#ffffff", ink: "#1a1f26", faint: "#5f6b79", grid: "#dfe4ea", cold: "#3f7fd0", warm: "#e0672a", mild: "#cfc4b2",
  },
  dark: {
    data: ["#56aee8", "#f0843c", "#e39bc4", "#9ad8ff"],
    theory: ["#eceff3", "#b4bcc6", "#8d96a1"],
    environment: ["#33c79c", "#e39bc4"],
    reference: ["#e69f00", "#56b4e9"],
    prediction: ["#c9a2f5"],
    species: { "dry air": "#aab5c2", water: "#4aaef5", molecule: "#aab5c2", disc: "#aab5c2", "light half": "#56aee8", "heavy half": "#f0843c", "gas from the left": "#56aee8", "gas from the right": "#f0b03c" },
    background: "#12161c", card: "#1a2028", edge: "#8492a3", metal: "#76828f", liquid: "#3fa2ee", traced: "#ff9a4d",
    sky: "#23415a", cloud: "#dfe6ee", ink: "#eef2f6", faint: "#9aa6b4", grid: "#2a323c", cold: "#4d8fe6", warm: "#f07a3a", mild: "#7d766b",
  },
};

// The second cue, besides colour, by which a curve differs from the others.
export const DASHES = {
  data: [[]],
  theory: [[6, 3], [1.5, 2.5], [10, 3, 2, 3]],
  environment: [[8, 3, 2, 3], [2, 3]],
  reference: [[]],
  prediction: [[12, 5]],
};

const COLDEST = 233, WARMEST = 333; // temperatures at which walls have their full colour [K]

export function parse(hex) {
  const number = parseInt(hex.replace("#", ""), 16);
  return [(number >> 16) / 255, ((number >> 8) & 255) / 255, (number & 255) / 255];
}

export function theme() {
  const wanted = document.documentElement.dataset.theme;
  if (wanted === "light" || wanted === "dark") return wanted;
  return matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
}

export const look = () => LOOKS[theme()];

export function speedColour(share) {
  const place = Math.min(Math.max(share, 0), 1) * (VIRIDIS.length - 1);
  const low = Math.min(Math.floor(place), VIRIDIS.length - 2);
  return mix(VIRIDIS[low], VIRIDIS[low + 1], place - low);
}

export const speedGradient = (bend) =>
  `linear-gradient(to right, ${VIRIDIS.map((_, place) => css(speedColour((place / (VIRIDIS.length - 1)) ** bend))).join(", ")})`;

export function wallColour(kelvin) {
  const { cold, mild, warm } = look();
  const share = Math.min(Math.max((kelvin - COLDEST) / (WARMEST - COLDEST), 0), 1) * 2;
  return share < 1 ? mix(parse(cold), parse(mild), share) : mix(parse(mild), parse(warm), share - 1);
}

export const curveColour = (role, index) => {
  const list = look()[role] ?? look().data;
  return list[index % list.length];
};

export const curveDash = (role, index) => {
  const list = DASHES[role] ?? DASHES.data;
  return list[index % list.length];
};

export const css = (rgb, alpha = 1) =>
  `rgba(${rgb.map((part) => Math.round(part * 255)).join(",")},${alpha})`;

function mix(first, second, share) {
  return first.map((part, index) => part + (second[index] - part) * share);
}
