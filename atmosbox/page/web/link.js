// The link that replays a run, and the page inside of another page.

import { correction, generate } from "./qr.mjs";
import { word } from "./words.js";

const LONGEST = 2900; // characters that fit into a QR code

const make = (kind, fields) => Object.assign(document.createElement(kind), fields);

export class Link {
  // `say(message)` asks the engine for the link.
  constructor(say) {
    const button = make("button", { type: "button", id: "link", title: word("link_title"), textContent: word("link") });
    Object.assign(button.dataset, { word: "link", wordTitle: "link_title" });
    button.onclick = () => say({ type: "link" });
    document.getElementById("save").after(button);
    addEventListener("hashchange", () => location.reload()); // another link was typed
  }

  // Copy a link and show it; a page without an address for others has a command.
  show(link) {
    const dialog = document.getElementById("sheet"), at = location.href.split("#")[0];
    const shared = /^https?:/.test(at) && !document.getElementById("plans");
    const text = shared ? at + link : `atmosbox run --replay "${link}"\n${link}`;
    const field = make("textarea", { id: "linked", readOnly: true, rows: 4, value: link ? text : "" });
    const told = make("p", { textContent: word(!link ? "link_none" : shared ? "link_address" : "link_command") });
    const done = make("p", { role: "status" }), code = make("canvas", { id: "code" });
    const close = make("form", { method: "dialog" });
    close.append(make("button", { textContent: word("close") }));
    dialog.replaceChildren(make("h2", { textContent: word("link") }), told, ...link ? [field, done] : [], close);
    if (link && shared && text.length <= LONGEST) {
      generate(text, { minCorrectionLevel: correction.L }).toCanvas(code, { on: [0, 0, 0], off: [255, 255, 255], pad: 4 });
      code.style.width = `${code.width * Math.max(Math.floor(400 / code.width), 2)}px`; // whole pixels
      close.before(code);
    } else if (link && shared) close.before(make("p", { textContent: word("link_long") }));
    dialog.showModal();
    field.select();
    navigator.clipboard?.writeText(text).then(() => { done.textContent = word("link_copied"); }, () => {});
  }
}

// Inside of another page: no header, and the height of this page is told to that page.
export function embed() {
  if (!new URLSearchParams(location.search).has("embed")) return;
  document.body.classList.add("embed");
  new ResizeObserver(() => parent.postMessage({ atmosbox: "height", height: document.body.offsetHeight }, "*")).observe(document.body);
}
