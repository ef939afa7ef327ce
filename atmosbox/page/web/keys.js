// The keyboard.

export const KEYS = [
  ["Space", "play or pause"],
  ["→  ←", "one frame on or back; ten with Shift"],
  ["↑  ↓", "faster, slower"],
  ["1 2 3 4", "camera: corner, front, above, close"],
  ["C", "colour by speed or by kind"],
  ["T", "follow one molecule; again: stop following"],
  ["D", "light or dark"],
  ["Home  End", "first and last moment"],
  ["?", "this list"],
];

// `actions`: what each key does, by the name that the browser gives it.
export function listen(actions) {
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const typing = event.target.matches?.("input:not([type=range]), select, textarea");
    const pressing = event.target.matches?.("button") && (event.key === " " || event.key === "Enter");
    const action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (typing || pressing || !action || document.querySelector("dialog[open]")) return;
    event.preventDefault();
    action(event);
  });
}
