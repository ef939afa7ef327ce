// The engine of the page, in a worker of its own: what goes to it and comes from it, and the files that it saves.

const read = (name) => document.getElementById(name)?.textContent;

const save = (name, text) => {
  const address = URL.createObjectURL(new Blob([text], { type: "text/csv" }));
  Object.assign(document.createElement("a"), { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
};

export class Engine {
  // Calls `hear(message)` for messages, `see(buffer)` for frames.
  constructor({ hear, see }) {
    const address = URL.createObjectURL(new Blob([read("worker")], { type: "text/javascript" }));
    this.worker = new Worker(address);
    this.worker.onmessage = ({ data }) => {
      if (data instanceof ArrayBuffer) see(data);
      else if (data.type === "file") save(data.name, data.text);
      else if (data.type === "plan") this.#plan(data.settings);
      else if (data.type === "digest") document.body.dataset.digest = data.sha256;
      else hear(data);
    };
    this.worker.onerror = ({ message }) => hear({ type: "note", level: "error", text: message });
    this.say({ type: "begin", served: read("plans") !== undefined, link: location.hash, starts: JSON.parse(read("starts")), module: read("module"), stored: read("stored") });
    document.addEventListener("visibilitychange", () => this.say({ type: "watched", is: !document.hidden }));
    document.addEventListener("ask", ({ detail }) => this.say(detail)); // used by tests
  }

  // Ask Python, which serves this page, for the plan of a box with other settings, and pass on its answer.
  async #plan(settings) {
    const address = new URL(read("plans") + location.search, location.origin);
    address.searchParams.set("settings", JSON.stringify(settings));
    let told = { refused: "atmosbox has ended, and only what acts at once can be changed: type atmosbox live once more." };
    try {
      const answer = await fetch(address);
      told = answer.ok ? await answer.json() : { refused: await answer.text() };
    } catch (error) {
      console.warn(error);
    }
    this.say({ type: "planned", ...told });
  }

  say(message) {
    this.worker.postMessage(message);
  }
}
