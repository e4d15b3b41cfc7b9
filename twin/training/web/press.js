// Tells the control of a press at once.
//
// Studio's page tells its server what the mouse and the keyboard do once per drawn frame, and a
// frame can take half a second where a processor draws it. So the state of the buttons and of the
// panel's keys is kept here, as the browser reports it. Every change is told by a copy of the page's
// last input message with the new state in it, on the page's own stream: what may act, what must be
// known to come in, and the order of things are the stream's, as before. The page's own messages get
// the same state written over theirs, so that no press acts twice.
(() => {
  "use strict";

  // Studio's input message (NetImgui 18, CmdInput): its length and kind, and where things stand.
  const LENGTH = 616;
  const KIND = 2;
  const AT = { kind: 4, height: 10, x: 12, y: 14, characters: 536, keyframe: 539, buttons: 552, keys: 560 };
  const STREAM = "/ui";
  const PARKED = -1; // Where the page says the mouse is while its own strip or menu has it.
  const SHOWN = "state_ack"; // The page says this for each picture the server has made.

  // The keys of the panel: the browser's number, and the bit in the message.
  const KEYS = new Map([
    [27, 14], [32, 12], [13, 13], // Escape, space, Enter
    [33, 5], [34, 6], [35, 8], [36, 7], // page up, page down, end, home
    [37, 1], [38, 3], [39, 2], [40, 4], // arrows: left, up, right, down
    [66, 35], [67, 36], [72, 41], [77, 46], [80, 49], [82, 51], // B, C, H, M, P, R
    [83, 52], [84, 53], [87, 56], // S, T, W
    [49, 25], [50, 26], [51, 27], [52, 28], [53, 29], [188, 85], [190, 87], // 1 to 5, comma, full stop
    [112, 60], [113, 61], [114, 62], [115, 63], // F1 to F4
    [173, 86], [189, 86], [61, 90], [187, 90], [107, 114], [109, 113], // - and +, twice
  ]);
  const ACTS_ON_TEXT = (number) => number === 13 || (number >= 33 && number <= 40);

  // A change waits until the server has looked at the one before: then a press and its release
  // between two looks are two states, not none. Of the pictures that come the first can be older
  // than the change, and so can all that had been waiting for this page.
  const PICTURES_APART = 3;
  const SHORTEST_MS = 40;
  const LONGEST_MS = 5000;

  const plain = WebSocket.prototype.send;
  let stream = null; // The panel's stream.
  let last = null; // The page's last message on it.
  let mouse = { x: 0, y: 0 };
  let held = { buttons: 0, keys: new Set() }; // As the browser reports it.
  let told = { buttons: 0, keys: new Set() }; // As the server knows it.
  let changes = []; // What the server does not know yet.
  let theirs = true; // Whether the page's own strip or menu has the mouse and the keys.
  let strip = false; // Whether the last press was on the strip.
  let typed = false; // Whether something was typed that the page has not told yet.
  let told_ms = -Infinity; // When the last change was told,
  let pictures = 0; // and how many pictures have come since.

  const copied = (state) => ({ buttons: state.buttons, keys: new Set(state.keys) });
  const area = (message) => new DataView(message.buffer, message.byteOffset, message.byteLength);
  const isInput = (message) =>
    message instanceof Uint8Array && message.length === LENGTH && message[AT.kind] === KIND;
  const inPanel = () => last !== null && mouse.y < area(last).getUint16(AT.height, true);

  function write(view, state) {
    view.setUint32(AT.buttons, state.buttons, true);
    for (const bit of KEYS.values()) {
      const place = AT.keys + (bit >> 3);
      const mask = 1 << (bit & 7);
      const rest = view.getUint8(place) & ~mask;
      view.setUint8(place, state.keys.has(bit) ? rest | mask : rest);
    }
  }

  function read(view) {
    const down = (bit) => view.getUint8(AT.keys + (bit >> 3)) & (1 << (bit & 7));
    return { buttons: view.getUint32(AT.buttons, true), keys: new Set([...KEYS.values()].filter(down)) };
  }

  function tell() {
    const now = performance.now();
    if (!changes.length || theirs || stream === null || stream.readyState !== WebSocket.OPEN) return;
    if (typed && changes[0].afterText) return; // The page's next message brings what was typed.
    const since = now - told_ms;
    if (pictures < PICTURES_APART && since < LONGEST_MS) return void setTimeout(tell, LONGEST_MS - since);
    const change = changes.shift();
    told = change.state;
    told_ms = now;
    pictures = 0;
    const message = last.slice();
    const view = area(message);
    write(view, told);
    view.setInt16(AT.x, change.x, true);
    view.setInt16(AT.y, change.y, true);
    view.setUint16(AT.characters, 0, true);
    view.setUint8(AT.keyframe, 0);
    plain.call(stream, message);
  }

  function note(afterText = false) {
    if (theirs) return;
    changes.push({ state: copied(held), ...mouse, afterText });
    tell();
  }

  // The page is about to tell its own state.
  function settle(message) {
    const view = area(message);
    const parked = view.getInt16(AT.x, true) === PARKED && view.getInt16(AT.y, true) === PARKED;
    last = message;
    const wereTheirs = theirs;
    theirs = strip || (parked && inPanel());
    if (theirs || wereTheirs) {
      told = read(view);
      changes = [];
      const same = told.buttons === held.buttons && [...KEYS.values()].every((bit) => told.keys.has(bit) === held.keys.has(bit));
      if (!theirs && !same) note();
    } else {
      write(view, told);
    }
    last = message.slice();
    typed = false;
  }

  WebSocket.prototype.send = function (message) {
    if (message === SHOWN && performance.now() - told_ms >= SHORTEST_MS) pictures += 1;
    const own = isInput(message) && new URL(this.url).pathname === STREAM;
    if (own) {
      if (stream !== this) theirs = true; // A new stream knows nothing of what was told.
      stream = this;
      settle(message);
    }
    plain.call(this, message);
    if (own || message === SHOWN) tell();
  };

  function point(event) {
    if (!event.isPrimary) return;
    const canvas = document.getElementById("canvas").getBoundingClientRect();
    mouse = { x: Math.round(event.clientX - canvas.left), y: Math.round(event.clientY - canvas.top) };
    const buttons = event.type === "pointercancel" ? 0 : event.buttons;
    if (buttons === held.buttons) return;
    if (held.buttons === 0) strip = !inPanel();
    theirs ||= strip;
    held.buttons = buttons;
    note();
  }

  function press(event) {
    const bit = KEYS.get(event.keyCode);
    const down = event.type === "keydown";
    if (down && (bit === undefined || event.key.length === 1)) typed = true;
    if (bit === undefined || down === held.keys.has(bit)) return;
    if (down && (event.ctrlKey || event.altKey || event.metaKey)) return;
    if (down) held.keys.add(bit);
    else held.keys.delete(bit);
    note(ACTS_ON_TEXT(event.keyCode));
  }

  function release() {
    if (!held.buttons && !held.keys.size) return;
    held = { buttons: 0, keys: new Set() };
    note();
  }

  for (const kind of ["pointerdown", "pointermove", "pointerup", "pointercancel"])
    window.addEventListener(kind, point, true);
  for (const kind of ["keydown", "keyup"]) window.addEventListener(kind, press, true);
  window.addEventListener("blur", release);
  document.addEventListener("visibilitychange", () => document.hidden && release());
})();
