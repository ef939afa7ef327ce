// Messages for the reader: a sentence that disappears after a while.

import { gloss, phrase, word } from "./words.js";

const SIGNS = { info: "i", warning: "!", error: "×" };
const WORDS = { warning: "note", error: "refused" };
const READING = 7000; // time after which a message disappears [ms]

export function note(parent, { level = "info", text }) {
  const card = document.createElement("div");
  card.className = `note ${level}`;
  const sign = Object.assign(document.createElement("b"), { textContent: SIGNS[level] ?? "i" });
  const words = Object.assign(document.createElement("span"), { textContent: (WORDS[level] ? word(WORDS[level]) : "") + phrase(text) });
  const close = Object.assign(document.createElement("button"), { type: "button", textContent: word("close") });
  close.onclick = () => card.remove();
  card.append(sign, words, close);
  parent.append(card);
  setTimeout(() => card.remove(), READING);
  while (parent.children.length > 4) parent.firstElementChild.remove();
}

// A term as it is written, which explains itself when it is clicked; the plain text if it needs no explanation.
export function explained(term) {
  const meaning = gloss(term);
  if (!meaning) return phrase(term);
  const button = Object.assign(document.createElement("button"), { type: "button", className: "term", textContent: phrase(term) });
  button.onclick = () => note(document.getElementById("notes"), { text: `${phrase(term)}: ${meaning}` });
  return button;
}
