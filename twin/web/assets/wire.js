// The binary messages of a machine: its state, patches of the stock, the mesh of a part that is cut from any side.

export const STATE = 1;
export const PATCH = 2;
export const MESH = 3;

const NAMES = ["position", "machine", "toGo", "lag", "load"];
const LOADS = ["spindleSpeed", "spindle", "force", "forceShare", "bend", "chip", "chipShare"];

/** The state as numbers; rows have one per axis. */
export function readState(buffer) {
  const head = new DataView(buffer);
  const flags = head.getUint8(1);
  const axes = head.getUint16(2, true);
  const numbers = new Float64Array(buffer, 8);
  const state = {
    time: numbers[0], speed: numbers[1], feed: numbers[2], rpm: numbers[3],
    tip: [numbers[4], numbers[5], numbers[6]],
    moving: !!(flags & 1), touches: !!(flags & 2), turns: !!(flags & 4), coolant: !!(flags & 8), cutting: !!(flags & 16),
  };
  NAMES.forEach((name, row) => { state[name] = Array.from(numbers.subarray(7 + row * axes, 7 + (row + 1) * axes)); });
  // A machine whose cut is not simulated has NaN here; another page's machine may have none at all.
  LOADS.forEach((name, place) => { state[name] = numbers[7 + NAMES.length * axes + place] ?? NaN; });
  return state;
}

/** A patch: its cells, their heights as shares of the blank's own height, and by which tool each was cut, where that is told. */
export async function readPatch(buffer) {
  const head = new DataView(buffer);
  const [epoch, row, column, rows, columns] = [head.getUint32(4, true), ...[8, 10, 12, 14].map((at) => head.getUint16(at, true))];
  const cells = rows * columns, bytes = await inflated(buffer, 16);
  const levels = new Uint16Array(bytes, 0, cells), tools = bytes.byteLength > 2 * cells ? new Uint8Array(bytes, 2 * cells, cells) : null;
  return { epoch, row, column, rows, columns, levels, tools };
}

/** A mesh: its vertices, three of them for each triangle, and the tool that left it. */
export async function readMesh(buffer) {
  const head = new DataView(buffer), [vertices, faces] = [4, 8].map((at) => head.getUint32(at, true));
  const bytes = await inflated(buffer, 12);
  return { points: new Float32Array(bytes, 0, 3 * vertices), corners: new Uint32Array(bytes, 12 * vertices, 3 * faces), by: new Uint8Array(bytes, 12 * (vertices + faces), faces) };
}

function inflated(buffer, begin) {
  return new Response(new Blob([new Uint8Array(buffer, begin)]).stream().pipeThrough(new DecompressionStream("deflate"))).arrayBuffer();
}
