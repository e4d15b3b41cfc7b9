// The form of the message by which Studio's page tells its server what the mouse and the keyboard do.
const StudioInput = (() => {
  "use strict";

  // NetImgui 18, CmdInput: its length and kind, and where things stand.
  const LENGTH = 616;
  const KIND = 2;
  const AT = { kind: 4, height: 10, x: 12, y: 14, letters: 24, count: 536, keyframe: 539, buttons: 552, keys: 560 };
  const MOST_LETTERS = 256;
  const PARKED = -1; // Where the page says the mouse is while its own strip or menu has it.

  // The keys of the panel and of its fields: the browser's number, and the bit in the message.
  const KEYS = new Map([
    [27, 14], [32, 12], [13, 13], [8, 11], [46, 10], [9, 0], // Escape, space, Enter, backspace, delete, tab
    [33, 5], [34, 6], [35, 8], [36, 7], // page up, page down, end, home
    [37, 1], [38, 3], [39, 2], [40, 4], // arrows: left, up, right, down
    [66, 35], [67, 36], [72, 41], [77, 46], [80, 49], [82, 51], // B, C, H, M, P, R
    [83, 52], [84, 53], [87, 56], // S, T, W
    [49, 25], [50, 26], [51, 27], [52, 28], [53, 29], [188, 85], [190, 87], // 1 to 5, comma, full stop
    [112, 60], [113, 61], [114, 62], [115, 63], // F1 to F4
    [173, 86], [189, 86], [61, 90], [187, 90], [107, 114], [109, 113], // - and +, twice
  ]);

  const area = (message) => new DataView(message.buffer, message.byteOffset, message.byteLength);
  const isOne = (message) =>
    message instanceof Uint8Array && message.length === LENGTH && message[AT.kind] === KIND;
  const height = (message) => area(message).getUint16(AT.height, true);

  function isParked(message) {
    const view = area(message);
    return view.getInt16(AT.x, true) === PARKED && view.getInt16(AT.y, true) === PARKED;
  }

  // Buttons, and those of the keys above that are down.
  function state(message) {
    const view = area(message);
    const down = (bit) => view.getUint8(AT.keys + (bit >> 3)) & (1 << (bit & 7));
    return { buttons: view.getUint32(AT.buttons, true), keys: new Set([...KEYS.values()].filter(down)) };
  }

  function putState(message, { buttons, keys }) {
    const view = area(message);
    view.setUint32(AT.buttons, buttons, true);
    for (const bit of KEYS.values()) {
      const place = AT.keys + (bit >> 3);
      const mask = 1 << (bit & 7);
      const rest = view.getUint8(place) & ~mask;
      view.setUint8(place, keys.has(bit) ? rest | mask : rest);
    }
  }

  function letters(message) {
    const view = area(message);
    const count = Math.min(view.getUint16(AT.count, true), MOST_LETTERS);
    return Array.from({ length: count }, (_, place) => view.getUint16(AT.letters + 2 * place, true));
  }

  function putLetters(message, codes) {
    const view = area(message);
    codes.forEach((code, place) => view.setUint16(AT.letters + 2 * place, code, true));
    view.setUint16(AT.count, codes.length, true);
  }

  // A copy with another state at another place, without what must not be said twice.
  function changed(message, { state, x, y, letters }) {
    const copy = message.slice();
    const view = area(copy);
    putState(copy, state);
    putLetters(copy, letters);
    view.setInt16(AT.x, x, true);
    view.setInt16(AT.y, y, true);
    view.setUint8(AT.keyframe, 0);
    return copy;
  }

  return { KEYS, MOST_LETTERS, isOne, height, isParked, state, putState, letters, putLetters, changed };
})();
