// The line to the room: what is asked for goes out at once, a held key says so again and again.

const BEAT_MS = 25;
const AGAIN_MS = 1000;

export class Connection {
  /** hear: what is called with each message; lost: called with whether the line is down. */
  constructor(hear, lost) {
    Object.assign(this, { hear, lost, held: null });
    this.open();
  }

  open() {
    const address = new URL("stream", location.href);
    address.protocol = address.protocol.replace("http", "ws");
    this.socket = new WebSocket(address);
    this.socket.binaryType = "arraybuffer";
    let came = false;
    this.socket.onopen = () => { came = true; this.lost(false); };
    this.socket.onmessage = ({ data }) => this.hear(data);
    this.socket.onclose = () => {
      this.let_go();
      this.lost(true);
      if (!came) this.ask_whether_known();
      setTimeout(() => this.open(), AGAIN_MS);
    };
  }

  /** A server that was started anew may not know this browser any more: the entry says what to do then. */
  async ask_whether_known() {
    const answer = await fetch("scene.json", { method: "HEAD" }).catch(() => null);
    if (answer?.status === 401) location.reload();
  }

  say(what) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(what));
  }

  /** Begin a motion that lasts while a key is held: it stops when these beats stop. */
  hold(command) {
    this.let_go();
    this.say(command);
    this.held = setInterval(() => this.say({ beat: 1 }), BEAT_MS);
  }

  let_go() {
    if (this.held === null) return;
    clearInterval(this.held);
    this.held = null;
    this.say({ do: "jog_stop" });
  }
}
