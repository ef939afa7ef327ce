// The connection to the running box: it passes on messages, reports when it is lost, and reconnects.

const SOONEST = 500, LATEST = 5000; // shortest and longest time between two attempts [ms]

export class Link {
  // Calls `hear(message)` for messages, `see(buffer)` for frames, `state("open" | "lost")` for the connection.
  constructor({ hear, see, state }) {
    Object.assign(this, { hear, see, state, wait: SOONEST });
    this.#connect();
  }

  #connect() {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    this.socket = new WebSocket(`${scheme}://${location.host}/socket${location.search}`);
    this.socket.binaryType = "arraybuffer";
    this.socket.onopen = () => {
      this.wait = SOONEST;
      this.state("open");
    };
    this.socket.onmessage = ({ data }) => {
      if (data instanceof ArrayBuffer) this.see(data);
      else this.hear(JSON.parse(data));
    };
    this.socket.onclose = () => {
      this.state("lost");
      setTimeout(() => this.#connect(), this.wait);
      this.wait = Math.min(2 * this.wait, LATEST);
    };
  }

  say(message) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }
}
