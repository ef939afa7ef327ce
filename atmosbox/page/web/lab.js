// The page of a box that runs in the page itself: a worker takes the place of the socket of a live page.

import { begin as beginLive } from "./live.js";

const read = (name) => document.getElementById(name).textContent;

const save = (name, text) => {
  const address = URL.createObjectURL(new Blob([text], { type: "text/csv" }));
  Object.assign(document.createElement("a"), { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
};

export class Bench {
  // Calls `hear(message)` for messages, `see(buffer)` for frames, `state("open" | "lost")` for the connection.
  constructor({ hear, see, state }) {
    const address = URL.createObjectURL(new Blob([read("worker")], { type: "text/javascript" }));
    this.worker = new Worker(address);
    this.worker.onmessage = ({ data }) => {
      if (data instanceof ArrayBuffer) see(data);
      else if (data.type === "file") save(data.name, data.text);
      else if (data.type === "digest") document.body.dataset.digest = data.sha256;
      else hear(data);
    };
    this.worker.onerror = ({ message }) => hear({ type: "note", level: "error", text: message });
    this.worker.postMessage({ type: "begin", starts: JSON.parse(read("starts")), module: read("module"), stored: read("stored") });
    document.addEventListener("visibilitychange", () => this.say({ type: "watched", is: !document.hidden }));
    state("open");
  }

  say(message) {
    this.worker.postMessage(message);
  }
}

export function begin() {
  const bench = beginLive(Bench, { saves: true });
  document.addEventListener("ask", ({ detail }) => bench.say(detail)); // used by tests
}
