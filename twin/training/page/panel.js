// The page of a room: fetches the scene, follows the machine, hands what is heard to the parts.

import { View } from "../view/view.js";
import { MESH, PATCH, readState, STATE } from "../view/wire.js";
import { Connection } from "./connection.js";
import { ControlDesk } from "./control_desk.js";
import { Editor } from "./editor.js";
import { Help } from "./help.js";
import { Looking } from "./looking.js";
import { act_on, LANGUAGE_NAMES, make, Words } from "./parts.js";
import { Preview } from "./preview.js";
import { Score } from "./score.js";
import { Screen } from "./screen.js";
import { Sheets } from "./sheets.js";
import { Trouble } from "./trouble.js";

const ASKED_AGAIN_MS = 1000;
const VIEWS = ["front", "top", "tool", "part", "fit"];

// The entry takes the token out of the address; a browser that is known already comes here with it.
if (location.hash) history.replaceState(null, "", location.pathname + location.search);

const scene = await room_scene();
const now = {};
let words, told = null, tool = null, follow = "start", queued = false, reloads = false;
const changed = new Set();

const base = new URL("./", location.href).pathname;
const view = new View(document.getElementById("canvas"), base, (what, detail) => {
  document.body.dataset.view = what;
  if (what === "failed") banner("no_view", detail);
});
const line = new Connection(hear, (down) => {
  document.body.dataset.line = down ? "down" : "up";
  if (down) banner("connection_lost");
  else if (document.body.dataset.view !== "failed") {
    told = null;
    document.getElementById("banner").hidden = true;
  }
});
const preview = new Preview(view), trouble = new Trouble(view), looking = new Looking(view, trouble);
const score = new Score(scene, line), editor = new Editor(line), help = new Help(scene);
const desk = new ControlDesk(scene, line), screen = new Screen(scene, line), sheets = new Sheets(scene, line, looking, desk, screen, score, editor);
let attempt = null;
screen.on_choice = () => { if (now.mode !== undefined && words) sheets.show(now, words); };

/** The scene, as soon as there is a room: one that is just being begun, or cannot be, says so until then. */
async function room_scene() {
  const element = document.getElementById("banner");
  for (;;) {
    const answer = await fetch("scene.json").catch(() => null);
    if (answer?.ok) {
      element.hidden = true;
      return answer.json();
    }
    element.textContent = (await answer?.json().catch(() => null))?.failed ?? "…";
    element.hidden = false;
    await new Promise((resume) => setTimeout(resume, ASKED_AGAIN_MS));
  }
}

function banner(name, detail = "") {
  told = [name, detail];
  if (!words) return;
  const element = document.getElementById("banner");
  element.textContent = `${words.label(name)} ${detail}`;
  element.hidden = false;
}

function hear(data) {
  if (typeof data === "string") {
    const said = JSON.parse(data);
    // Another attempt has another machine, and perhaps another scene: the page begins anew with it, and shows nothing of it before.
    attempt ??= said.attempt;
    if (said.attempt !== undefined && said.attempt !== attempt) reloads = true;
    if (reloads) return location.reload();
    for (const name of Object.keys(said)) changed.add(name);
    Object.assign(now, said);
    if (now.tool !== tool) view.say("load", tool = now.tool);
    return show_soon();
  }
  const kind = new Uint8Array(data, 0, 1)[0];
  if (kind === PATCH || kind === MESH) return view.patch(data);
  if (kind !== STATE) return undefined;
  const state = readState(data);
  view.say("state", data);
  Object.assign(now, { state });
  sheets.state = state;
  return show_soon();
}

/** Show what was heard, once for each picture that the browser draws. */
function show_soon() {
  if (queued || !words) return;
  queued = true;
  (document.hidden ? setTimeout : requestAnimationFrame)(() => {
    queued = false;
    if (now.mode === undefined) return;
    if (changed.size) {
      desk.show(now, words);
      screen.show(now, words, changed);
      sheets.show(now, words);
      score.show(now, words);
      preview.show(now, changed);
      trouble.show(now);
      if (changed.has("finder")) view.say("finder", now.finder);
      help.show(now, words);
      editor.show(now, words, changed);
      show_hand_over();
      changed.clear();
      document.body.dataset.ready = "yes";
    }
    if (now.state) screen.show_state(now.state);
  });
}

function show_hand_over() {
  const box = document.getElementById("handover");
  const button = (name, what) => {
    const made = make("button", { type: "button", "data-key": `panel ${what}` }, words.label(name));
    act_on(made, () => line.say({ panel: what }));
    return made;
  };
  const key = JSON.stringify([now.role, now.has_panel, now.asked, now.somebody_asks, words.language]);
  if (box.dataset.shown === key) return;
  box.dataset.shown = key;
  const asks = now.role === "operator" && !now.has_panel;
  box.hidden = !(asks || now.somebody_asks);
  if (now.somebody_asks) box.replaceChildren(words.label("somebody_asks"), button("give_panel", "give"), button("keep_panel", "keep"));
  else if (asks) box.replaceChildren(words.label(now.asked ? "panel_asked" : "panel_elsewhere"), ...(now.asked ? [] : [button("ask_panel", "ask")]));
}

async function speak(language) {
  words = new Words(language, await (await fetch(`words/${language}.json`)).json());
  localStorage.setItem("language", language);
  document.documentElement.lang = language;
  document.title = `${words.text(scene.title)} - ${words.label("title")}`;
  words.fill(document);
  document.getElementById("views").replaceChildren(...VIEWS.map((name) => {
    const button = make("button", { type: "button", "data-key": `view ${name}`, "aria-pressed": name === follow }, words.label(`view_${name}`));
    act_on(button, () => {
      follow = name;
      view.say("look", name);
      for (const one of button.parentElement.querySelectorAll("[data-key^='view ']")) one.setAttribute("aria-pressed", one === button);
    });
    return button;
  }), preview.button(words));
  if (told) banner(...told);
  for (const name of Object.keys(now)) changed.add(name);
  show_soon();
}

const chooser = document.getElementById("language");
chooser.replaceChildren(...scene.languages.map((language) => make("option", { value: language }, LANGUAGE_NAMES[language])));
const wanted = new URLSearchParams(location.search).get("language") ?? scene.language;
chooser.value = scene.languages.includes(wanted) ? wanted : scene.language;
chooser.addEventListener("change", () => { speak(chooser.value); chooser.blur(); });
await speak(chooser.value);
