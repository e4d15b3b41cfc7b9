// Plays a recorded run: what stands at a moment is looked up in its samples, the view draws it.

import { View } from "../view/view.js";
import { MESH, readMesh, readPatch } from "../view/wire.js";
import { Chart, worst_blocks } from "./chart.js";

const VIEWS = { front: "Front", top: "Top", tool: "Tool", part: "Part", fit: "Fit" };
const SHOWN = { trail: "Path", stock: "Part as cut", collision: "Collision bodies" };
const WORST = 5; // Marks of the worst blocks.
const FINEST_MM = 0.1; // Between points of the drawn path.
const COLOURS = [[0.15, 0.34, 0.84], [0.16, 0.71, 0.66], [0.56, 0.82, 0.29], [0.95, 0.76, 0.19], [0.88, 0.23, 0.14]];

const at = (id) => document.getElementById(id);
const button = (text, act, pressed = null) => {
  const made = document.createElement("button");
  made.type = "button";
  made.textContent = text;
  if (pressed !== null) made.setAttribute("aria-pressed", pressed);
  made.addEventListener("click", () => act(made));
  return made;
};
const banner = (text) => { at("banner").textContent = text; at("banner").hidden = !text; };

const run = await (await fetch("run.json")).json();
const base = new URL("./", location.href).pathname;
const view = new View(at("canvas"), base, (what, detail) => {
  document.body.dataset.view = what;
  if (what === "failed") banner(`The view cannot be drawn by this browser: ${detail}`);
});

banner("Reading the recording …");
const buffer = await (await fetch("samples.bin")).arrayBuffer();
const [count, axes] = new Uint32Array(buffer, 0, 2);
const column = (number) => new Float32Array(buffer, 8 + 4 * count * number, count);
const [times, lines, tools, errors, speeds, feeds] = [0, 1, 2, 3, 4, 5].map(column);
const tips = [6, 7, 8].map(column), joints = Array.from({ length: axes }, (_, axis) => column(9 + axis));
const last = count - 1;
/** Where blocks begin: each run of samples of one line. */
const starts = [...lines.keys()].filter((i) => i === 0 || lines[i] !== lines[i - 1]);
const worst = run.has_error ? worst_blocks(errors, starts, WORST) : [];
const chart = new Chart(at("chart"), at("pointed"), {
  times, feeds, speeds, errors: run.has_error ? errors : null, worst, alarms: run.alarms.map(([when]) => when),
  text: (index) => `${times[index].toFixed(3)} s · line ${lines[index]} · ${values(index)}`, sample, jump,
});
let now = 0, tool = null, playing = false, following = false, before = 0, shown_line = -1;

/** The last sample that is not later than a time. */
function sample(time) {
  let low = 0, high = last;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle - 1;
  }
  return low;
}

function show(index) {
  now = index;
  if (tools[index] !== tool) view.say("load", tool = tools[index]);
  show_machine({ time: times[index], line: lines[index], machine: joints.map((values) => values[index]), tip: tips.map((values) => values[index]) });
  at("figures").textContent = `T ${tool} · ${values(index)}`;
  at("clock").textContent = `${times[index].toFixed(3)} of ${times[last].toFixed(1)} s`;
  at("time").value = times[index];
  at("time").setAttribute("aria-valuetext", `${times[index].toFixed(3)} s, line ${lines[index]}`);
  chart.point(index);
}

/** Show where the machine is, and its block. */
function show_machine({ time, line, machine, tip }) {
  view.say("moment", { time, machine, tip, turns: playing, coolant: false, cutting: false });
  [...at("axes").rows].forEach((row, axis) => {
    row.cells[1].textContent = (machine[axis] - run.part_zero[axis]).toFixed(3);
    row.cells[2].textContent = machine[axis].toFixed(3);
  });
  if (line !== shown_line) {
    at("program").querySelector(".runs")?.classList.remove("runs");
    const row = at("program").children[line - 1];
    row?.classList.add("runs");
    row?.scrollIntoView({ block: "nearest" });
    shown_line = line;
  }
  document.body.dataset.line = line;
}

function play(on) {
  follow(false);
  playing = on;
  at("play").textContent = on ? "Pause" : "Play";
  at("play").setAttribute("aria-pressed", on);
  if (on && now === last) show(0);
  before = performance.now();
  time = times[now];
  if (on) requestAnimationFrame(step);
}

let time = 0;
function step(clock) {
  if (!playing) return;
  time += 0.001 * (clock - before) * Number(at("speed").value);
  before = clock;
  show(sample(time));
  if (now === last) play(false);
  else requestAnimationFrame(step);
}

function jump(index) {
  play(false);
  show(index);
}

/** Show where a machine is that makes the run again, or stop doing so. */
function follow(on) {
  following = on;
  at("live").setAttribute("aria-pressed", on);
}

/** Where the address asks for: #t=SECONDS or #line=NUMBER. */
function asked() {
  const [, what, value] = /^#(t|line)=([\d.]+)$/.exec(location.hash) ?? [];
  if (what === "t") return sample(Number(value));
  return what === "line" ? first_of.get(Number(value)) : undefined;
}

function colour(share) {
  const place = Math.min(0.9999, Math.max(0, share)) * (COLOURS.length - 1), low = Math.floor(place);
  return COLOURS[low].map((value, i) => value + (place - low) * (COLOURS[low + 1][i] - value));
}

/** The path, in stretches that can be told apart; each has the colour of its greatest error. */
function draw_path() {
  const places = [], colours = [];
  let from = null, error = 0;
  for (let i = 0; i < count; i++) {
    const tip = tips.map((values) => values[i]);
    error = Math.max(error, errors[i]);
    if (from && i < last && Math.hypot(...tip.map((value, k) => value - from[k])) < FINEST_MM) continue;
    places.push(...tip);
    colours.push(...(run.has_error && run.error_scale_um ? colour(error / run.error_scale_um) : [1, 0.54, 0.12]));
    [from, error] = [tip, 0];
  }
  view.say("path", { places: new Float32Array(places), colours: new Float32Array(colours) });
}

/** Feed, spindle speed and error at a sample. */
function values(index) {
  const shown = [`F ${feeds[index].toFixed(0)} mm/min`];
  if (chart.has_speed) shown.push(`S ${Math.abs(speeds[index]).toFixed(0)} /min`);
  if (run.has_error) shown.push(`contour error ${errors[index].toFixed(1)} µm`);
  return shown.join(" · ");
}

/** Go to the beginning of the next block, or of this one and then the one before. */
function step_block(way) {
  const next = starts.findIndex((start) => start > now), place = next < 0 ? starts.length : next;
  const here = starts[place - 1];
  jump(way > 0 ? starts[place] ?? last : now > here ? here : starts[place - 2] ?? 0);
}

/** The cuts of the stock, each with its time. */
async function read_cuts() {
  const cuts_of = await (await fetch("cuts.bin")).arrayBuffer();
  const head = new DataView(cuts_of), found = [];
  for (let place = 0; place < cuts_of.byteLength;) {
    const length = head.getUint32(place, true);
    const message = cuts_of.slice(place + 8, place + 8 + length), of_mesh = head.getUint8(place + 8) === MESH;
    found.push({ time: head.getFloat32(place + 4, true), ...(of_mesh ? { mesh: await readMesh(message) } : { patch: await readPatch(message) }) });
    place += 8 + length;
  }
  view.say("cuts", found);
  show(now);
}

at("title").textContent = run.program.split(/[\\/]/).at(-1);
at("title").title = run.program;
at("about").textContent = `${run.machine} · ${run.dialect}`;
at("axes").tBodies[0].replaceChildren(...run.axes.map((axis) => {
  const row = document.createElement("tr");
  row.innerHTML = '<th scope="row"></th><td></td><td class="quiet"></td>';
  row.firstChild.textContent = axis;
  return row;
}));
const first_of = new Map();
for (let i = last; i >= 0; i--) first_of.set(lines[i], i);
at("program").replaceChildren(...run.source.map((text, index) => {
  const row = document.createElement("li"), number = document.createElement("i");
  number.textContent = index + 1;
  row.append(number, text);
  row.setAttribute("role", "option");
  row.id = `line${index + 1}`;
  if (first_of.has(index + 1)) row.addEventListener("click", () => jump(first_of.get(index + 1)));
  else row.className = "idle";
  return row;
}));
at("program").addEventListener("keydown", (event) => {
  const way = { ArrowDown: 1, ArrowUp: -1 }[event.key];
  if (!way) return;
  event.preventDefault();
  let line = shown_line + way;
  while (line > 0 && line <= run.source.length && !first_of.has(line)) line += way;
  if (first_of.has(line)) jump(first_of.get(line));
});
at("time").max = times[last];
at("time").addEventListener("input", () => jump(sample(Number(at("time").value))));
at("play").addEventListener("click", () => play(!playing));
addEventListener("keydown", (event) => {
  if (event.code !== "Space" || event.target.matches("button, select, input")) return;
  event.preventDefault();
  play(!playing);
});
for (const [id, way] of [["back", -1], ["on", 1]]) at(id).addEventListener("click", () => step_block(way));
if (run.has_error) {
  let place = 0;
  at("moments").append(button(`Worst: ${errors[worst[0]].toFixed(1)} µm`, (made) => {
    jump(worst[place]);
    place = (place + 1) % worst.length;
    made.textContent = `Worst ${place + 1} of ${worst.length}: ${errors[worst[place]].toFixed(1)} µm`;
  }));
  for (const index of worst) at("program").children[lines[index] - 1]?.classList.add("worst");
  at("legend").hidden = false;
  at("scale").textContent = `${run.error_scale_um.toFixed(0)} µm`;
}
for (const [when, text] of run.alarms) at("moments").append(button(`Alarm: ${text}`, () => jump(sample(when))));
at("views").append(
  ...Object.entries(VIEWS).map(([name, label]) => button(label, () => view.say("look", name))),
  ...Object.entries(SHOWN).map(([name, label]) => button(label, (made) => {
    const on = made.getAttribute("aria-pressed") !== "true";
    made.setAttribute("aria-pressed", on);
    view.say("show", { [name]: on });
  }, name !== "collision")),
);
banner("");
view.say("show", { trail: true });
show(asked() ?? last);
addEventListener("hashchange", () => { if (asked() !== undefined) jump(asked()); });
at("report").hidden = !run.has_report;
document.body.classList.toggle("goes_on", Boolean(run.goes_on));
if (run.is_live) {
  at("live").hidden = false;
  at("live").addEventListener("click", () => { play(false); follow(true); });
  follow(asked() === undefined);
  const socket = new WebSocket(new URL("now", location.href).href.replace(/^http/, "ws"));
  socket.addEventListener("message", ({ data }) => {
    const moment = JSON.parse(data);
    if (run.goes_on) {
      show_machine(moment);
      at("clock").textContent = `${moment.time.toFixed(3)} s`;
    } else if (following) show(sample(moment.time));
  });
  socket.addEventListener("close", () => { at("live").disabled = true; banner("The machine has been switched off."); });
}
draw_path();
await read_cuts();
document.body.dataset.ready = "yes";
