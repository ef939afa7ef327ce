// The keyboard.

import { word } from "./words.js";

export const keys = () => [
  [word("space"), word("key_play")],
  ...(document.body.classList.contains("lab") ? [["→", word("on")]] : [["→  ←", word("key_step")]]),
  ["↑  ↓", word("key_pace")],
  ["1 2 3 4", word("key_camera")],
  ["C", word("key_colour")],
  ["T", word("key_trace")],
  ["D", word("key_theme")],
  ...(document.body.classList.contains("lab")
    ? [["M", word("key_say")], ["U", word("key_undo")], ["R", word("key_again")]] : [["Home  End", word("key_ends")]]),
  ["?", word("key_help")],
];

// `actions`: the function of each key, by the browser's name of the key.
export function listen(actions) {
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const typing = event.target.matches?.("input:not([type=range]), select, textarea");
    const pressing = event.target.matches?.("button") && (event.key === " " || event.key === "Enter");
    const sliding = event.target.matches?.("input[type=range]") && /^(Arrow|Page|Home|End)/.test(event.key);
    const action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (typing || sliding || pressing || !action || document.querySelector("dialog[open]")) return;
    event.preventDefault();
    action(event);
  });
}
