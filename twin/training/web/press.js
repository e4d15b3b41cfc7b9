// Tells the control of a press at once.
//
// Studio's page tells its server what the mouse and the keyboard do once per drawn frame, and a
// frame can take half a second where a processor draws it. So the state of the buttons and of the
// panel's keys, and what is typed, are kept here, as the browser reports them. Every change is told
// by a copy of the page's last input message with the change in it, on the page's own stream: what
// may act, what must be known to come in, and the order of things are the stream's, as before. The
// page's own messages get the same state written over theirs, and lose the letters that are told
// here, so that nothing acts twice.
(() => {
  "use strict";

  const STREAM = "/ui";
  const SHOWN = "state_ack"; // The page says this for each picture the server has made.
  // Escape, Enter, backspace, delete, tab, arrows and their like do something with what was typed.
  const ACTS_ON_TEXT = (number) => [8, 9, 13, 27, 46].includes(number) || (number >= 33 && number <= 40);

  // A change waits until the server has looked at the one before: then a press and its release
  // between two looks are two states, not none. Of the pictures that come the first can be older
  // than the change, and so can all that had been waiting for this page.
  const PICTURES_APART = 3;
  const SHORTEST_MS = 40;
  const LONGEST_MS = 5000; // So long a server without pictures, or a page without letters, is waited for.

  const plain = WebSocket.prototype.send;
  let stream = null; // The panel's stream.
  let last = null; // The page's last message on it.
  let mouse = { x: 0, y: 0 };
  let held = { buttons: 0, keys: new Set() }; // As the browser reports it.
  let told = { buttons: 0, keys: new Set() }; // As the server knows it.
  let changes = []; // What the server does not know yet.
  let again = []; // Letters that the page has still to tell, and that are told here.
  let theirs = true; // Whether the page's own strip or menu has the mouse and the keys.
  let strip = false; // Whether the last press was on the strip.
  let told_ms = -Infinity; // When the last change was told,
  let pictures = 0; // and how many pictures have come since.

  const copied = (state) => ({ buttons: state.buttons, keys: new Set(state.keys) });
  const inPanel = () => last !== null && mouse.y < StudioInput.height(last);
  const isSame = (one, other) =>
    one.buttons === other.buttons &&
    [...StudioInput.KEYS.values()].every((bit) => one.keys.has(bit) === other.keys.has(bit));

  function tell() {
    const now = performance.now();
    if (!changes.length || theirs || stream === null || stream.readyState !== WebSocket.OPEN) return;
    const since = now - told_ms;
    if (pictures < PICTURES_APART && since < LONGEST_MS) return void setTimeout(tell, LONGEST_MS - since);
    const change = changes.shift();
    told = change.state;
    told_ms = now;
    pictures = 0;
    plain.call(stream, StudioInput.changed(last, change));
  }

  // Whether the server may learn of two changes in one, and misses nothing of the first.
  function joins(change, next) {
    if (!change || change.acts || next.acts || change.state.buttons !== next.state.buttons) return false;
    if (change.letters.length + next.letters.length > StudioInput.MOST_LETTERS) return false;
    const before = (changes.at(-2)?.state ?? told).keys;
    const [then, later] = [change.state.keys, next.state.keys];
    return [...StudioInput.KEYS.values()].every(
      (bit) => before.has(bit) === then.has(bit) || then.has(bit) === later.has(bit));
  }

  function note({ letters = [], acts = false } = {}) {
    if (theirs) return;
    const next = { state: copied(held), ...mouse, letters, acts };
    const change = changes.at(-1);
    again.push(...letters.map((code) => ({ code, since: performance.now() })));
    if (joins(change, next)) {
      change.state = next.state;
      change.letters.push(...letters);
    } else {
      changes.push(next);
    }
    tell();
  }

  // Of the letters that the page tells: those that are not told here.
  function unheard(letters) {
    again = again.filter((letter) => performance.now() - letter.since < LONGEST_MS);
    return letters.filter((code) => {
      const place = again.findIndex((letter) => letter.code === code);
      if (place >= 0) again.splice(place, 1);
      return place < 0;
    });
  }

  // The page is about to tell its own state.
  function settle(message) {
    last = message;
    const wereTheirs = theirs;
    theirs = strip || (StudioInput.isParked(message) && inPanel());
    if (theirs || wereTheirs) {
      told = StudioInput.state(message);
      changes = [];
      again = [];
      if (!theirs && !isSame(told, held)) note();
    } else {
      StudioInput.putState(message, told);
      StudioInput.putLetters(message, unheard(StudioInput.letters(message)));
    }
    last = message.slice();
  }

  WebSocket.prototype.send = function (message) {
    if (message === SHOWN && performance.now() - told_ms >= SHORTEST_MS) pictures += 1;
    const own = StudioInput.isOne(message) && new URL(this.url).pathname === STREAM;
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
    const down = event.type === "keydown";
    const shortcut = (event.ctrlKey || event.altKey || event.metaKey) && !event.getModifierState("AltGraph");
    if (down && shortcut) return;
    const letters = down && event.key.length === 1 ? [event.key.charCodeAt(0)] : [];
    const bit = StudioInput.KEYS.get(event.keyCode);
    const changed = bit !== undefined && down !== held.keys.has(bit);
    if (changed && down) held.keys.add(bit);
    else if (changed) held.keys.delete(bit);
    if (changed || letters.length) note({ letters, acts: changed && down && ACTS_ON_TEXT(event.keyCode) });
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
