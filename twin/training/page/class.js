// The teacher's page of a class: who is where, who is stuck, what has been reached; hold, hand out, look in.

import { LANGUAGE_NAMES, act_on, make, Words, write } from "./parts.js";

const AGAIN_MS = 1000;

if (location.hash) history.replaceState(null, "", location.pathname + location.search);
const about = await (await fetch("class.json")).json();
const at = (id) => document.getElementById(id);
const chosen = new Set(), rows = new Map();
let words, socket, seats = [], scene = Object.keys(about.scenes)[0], known = null;

function open() {
  const address = new URL("stream", location.href);
  address.protocol = address.protocol.replace("http", "ws");
  socket = new WebSocket(address);
  socket.onmessage = ({ data }) => {
    const said = JSON.parse(data);
    if (said.refused) return tell(said.refused);
    ({ seats } = said);
    return show();
  };
  socket.onopen = () => tell("");
  socket.onclose = async () => {
    if (words) tell(words.label("connection_lost"));
    const answer = await fetch("class.json", { method: "HEAD" }).catch(() => null);
    if (answer?.status === 401) location.reload();
    else setTimeout(open, AGAIN_MS);
  };
}

const tell = (text) => write(at("told"), text);
const say = (what) => { if (socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify(what)); };

/** Those that are marked; where none is, the whole class. */
const meant = () => seats.map(({ key }) => key).filter((key) => !chosen.size || chosen.has(key));

function button(name, text, act) {
  const made = make("button", { type: "button", "data-key": name }, text);
  act_on(made, act);
  return made;
}

function show_acts() {
  const choice = make("select", { "data-key": "scene", "aria-label": words.label("story") }, ...Object.entries(about.scenes).map(([name, title]) => make("option", { value: name }, words.text(title))));
  choice.value = scene;
  choice.addEventListener("change", () => { scene = choice.value; });
  at("acts").replaceChildren(
    button("hold", words.label("hold_class"), () => say({ do: "hold", seats: meant() })),
    button("go on", words.label("go_on"), () => say({ do: "go_on", seats: meant() })),
    choice,
    button("hand out", words.label("hand_out"), () => {
      const keys = meant(), title = words.text(about.scenes[scene]);
      if (confirm(words.label("ask_hand_out", { title, count: keys.length }))) say({ do: "hand_out", seats: keys, scene });
    }),
    make("span", { class: "quiet", id: "meant" }),
  );
  at("exports").replaceChildren(
    make("a", { href: "marks.csv", download: true }, words.label("marks_csv")), " · ",
    make("a", { href: "marks.json", download: true }, words.label("marks_xapi")),
  );
  const heads = ["", "name", "story", "state", "score", "marks", ""];
  at("seats").tHead.replaceChildren(make("tr", {}, ...heads.map((name, place) => (name ? make("th", { scope: "col" }, words.label(name)) : make("td", { "data-place": place })))));
}

function show_meant() {
  write(at("meant"), chosen.size ? words.label("meant_some", { count: chosen.size }) : words.label("meant_all"));
}

/** Where a pupil is, in a word and a colour. */
function state_of({ room, failed, held }) {
  if (failed) return ["room_failed", "red"];
  if (!room) return [held ? "frozen" : "away", "quiet"];
  if (room.frozen) return ["frozen", "blue"];
  if (room.over) return ["over", "blue"];
  if (room.alarm) return ["alarm", "red"];
  if (room.held) return ["held", "yellow"];
  return room.running ? ["running", "green"] : ["ready", ""];
}

function show() {
  if (!words) return;
  if (known === null || JSON.stringify(seats.map(({ key }) => key)) !== known) {
    known = JSON.stringify(seats.map(({ key }) => key));
    rows.clear();
    at("seats").tBodies[0].replaceChildren(...seats.map((seat) => {
      const row = make("tr", { "data-seat": seat.key });
      rows.set(seat.key, { row, shown: "" });
      return row;
    }));
  }
  for (const seat of seats) {
    const kept = rows.get(seat.key), shown = JSON.stringify([seat, words.language]);
    if (kept.shown === shown) continue;
    kept.shown = shown;
    fill(kept.row, seat);
  }
  show_meant();
}

function fill(row, seat) {
  const { room, failed } = seat, [state, colour] = state_of(seat), focus = row.contains(document.activeElement) ? document.activeElement.dataset.key : null;
  const mark = make("input", { type: "checkbox", "data-key": "mark", "aria-label": `${words.label("mark_pupil")} ${seat.name}` });
  mark.checked = chosen.has(seat.key);
  mark.addEventListener("change", () => {
    if (mark.checked) chosen.add(seat.key);
    else chosen.delete(seat.key);
    show_meant();
  });
  const where = [];
  if (room) where.push(words.label(`mode_${room.mode}`), room.line ? `${words.label("line")} ${room.line}` : "");
  if (room?.alarm) where.push(`${words.alarm(room.alarm).name} ${room.block}`.trim());
  if (room?.stuck) where.push(words.label(`stuck_${room.stuck}`));
  if (room?.trouble) where.push(`${words.label("not_written")}: ${room.trouble}`);
  if (failed) where.push(failed);
  if (room && !room.pages) where.push(words.label("page_closed"));
  const marks = seat.marks.map(({ title, points, of, attempts }) => make("div", {}, `${words.text(title)}: `, make("b", { class: points === of ? "green" : "" }, `${points}/${of}`), attempts > 1 ? ` (${words.label("attempts", { count: attempts })})` : ""));
  row.className = room?.stuck ? "stuck" : "";
  row.replaceChildren(
    make("td", {}, mark), make("th", { scope: "row" }, seat.name), make("td", {}, words.text(seat.title)),
    make("td", {}, make("span", { class: `chip ${colour}` }, words.label(state)), " ", make("span", { class: "quiet" }, where.filter(Boolean).join(" · "))),
    make("td", { class: "number" }, room ? `${room.points} / ${room.of}${room.hints ? ` · ${words.label("hints_taken", { count: room.hints })}` : ""}` : ""),
    make("td", {}, ...marks),
    make("td", {}, make("div", { class: "keys" },
      make("a", { class: "button", "data-key": "look", href: `${seat.key}/`, target: "_blank", "aria-label": `${words.label("look_in")} ${seat.name}` }, words.label("look_in")),
      button("copy", words.label("copy_link"), () => navigator.clipboard.writeText(seat.link).then(() => tell(words.label("link_copied", { name: seat.name })), () => tell(seat.link))),
    )),
  );
  if (focus) row.querySelector(`[data-key="${focus}"]`)?.focus();
}

async function speak(language) {
  words = new Words(language, await (await fetch(`words/${language}.json`)).json());
  document.documentElement.lang = language;
  document.title = words.label("class");
  words.fill(document);
  show_acts();
  show();
  document.body.dataset.ready = "yes";
}

const chooser = at("language");
chooser.replaceChildren(...about.languages.map((language) => make("option", { value: language }, LANGUAGE_NAMES[language])));
chooser.value = about.languages.includes(new URLSearchParams(location.search).get("language")) ? new URLSearchParams(location.search).get("language") : about.language;
chooser.addEventListener("change", () => speak(chooser.value));
open();
await speak(chooser.value);
