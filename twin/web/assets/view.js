// The view of a machine on a page: hands the canvas to a worker, and tells it what the hand does.

const STILL_PX = 4; // A hand that moved farther has turned the view.

export class View {
  /** canvas; address of the machine's files; tell: called with "ready" or "failed". */
  constructor(canvas, address, tell) {
    this.canvas = canvas;
    this.waiting = [];
    this.ready = false;
    this.worker = null;
    this.measuring = false;
    this.on_measured = () => {};
    try {
      this.worker = new Worker(new URL("./view_worker.js", import.meta.url), { type: "module" });
      const surface = canvas.transferControlToOffscreen();
      this.worker.onerror = () => tell("failed", "");
      this.worker.onmessage = ({ data }) => {
        if (data.pictures !== undefined) Object.assign(document.body.dataset, { pictures: data.pictures, drawing: Math.round(data.drawing_ms) });
        if (data.failed) tell("failed", data.failed);
        if (data.measured) this.on_measured(data.measured);
        if (data.ready) {
          this.ready = true;
          this.waiting.splice(0).forEach((said) => this.say(...said));
          tell("ready", data.fine);
        }
      };
      const { width, height } = canvas.getBoundingClientRect();
      const quality = new URLSearchParams(location.search).get("quality");
      this.worker.postMessage(["open", { canvas: surface, width, height, ratio: devicePixelRatio, address, quality }], [surface]);
    } catch (error) {
      tell("failed", String(error));
      return;
    }
    new ResizeObserver(() => this.say("size", [canvas.clientWidth, canvas.clientHeight])).observe(canvas);
    this.follow_hand();
  }

  say(what, given, moved = []) {
    this.worker?.postMessage([what, given], moved);
  }

  /** Patches come before the machine is there; they wait for it. */
  patch(buffer) {
    if (this.ready) this.say("patch", buffer, [buffer]);
    else this.waiting.push(["patch", buffer]);
  }

  follow_hand() {
    const fingers = new Map();
    const canvas = this.canvas;
    let pressed = null;
    canvas.addEventListener("pointerdown", ({ clientX, clientY, button }) => { pressed = this.measuring && button === 0 ? [clientX, clientY] : null; });
    canvas.addEventListener("pointerup", ({ clientX, clientY }) => {
      if (!pressed || Math.hypot(clientX - pressed[0], clientY - pressed[1]) > STILL_PX) return;
      const box = canvas.getBoundingClientRect();
      this.say("measure", [(2 * (clientX - box.left)) / box.width - 1, 1 - (2 * (clientY - box.top)) / box.height]);
    });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.say("turn", { zoom: Math.exp(0.0012 * event.deltaY) });
    }, { passive: false });
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      fingers.set(event.pointerId, event);
    });
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) canvas.addEventListener(end, (event) => fingers.delete(event.pointerId));
    canvas.addEventListener("pointermove", (event) => {
      const before = fingers.get(event.pointerId);
      if (!before) return;
      const [dx, dy] = [event.clientX - before.clientX, event.clientY - before.clientY];
      const others = [...fingers.values()].filter((one) => one.pointerId !== event.pointerId);
      fingers.set(event.pointerId, event);
      if (others.length > 1) return;
      if (others.length === 1) {
        const apart = (one) => Math.hypot(one.clientX - others[0].clientX, one.clientY - others[0].clientY);
        this.say("turn", { zoom: apart(before) / Math.max(1, apart(event)), pan: [dx / 1600, dy / 1600] });
      } else if (event.buttons & 2 || event.shiftKey) this.say("turn", { pan: [dx / 800, dy / 800] });
      else this.say("turn", { azimuth: 0.008 * dx, elevation: 0.008 * dy });
    });
  }
}
