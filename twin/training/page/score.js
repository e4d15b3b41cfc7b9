// The score sheet of a scene that was handed in, over the view: what went wrong, and what comes next.

import { act_on, make, reveal } from "./parts.js";

export class Score {
  constructor(scene, line) {
    Object.assign(this, { scene, line, over: false, language: "", closed: false });
    this.box = document.getElementById("score");
  }

  /** Show the sheet when the scene has been handed in, and hide it when that is taken back. */
  show(now, words) {
    Object.assign(this, { now, words });
    const acts = now.role === "trainer" || now.has_panel;
    const key = JSON.stringify([now.over, words.language, acts]);
    if (key === this.shown) return;
    this.shown = key;
    if (!now.over) this.closed = false;
    if (now.over && !this.closed) this.open();
    else this.box.hidden = true;
  }

  async open() {
    const { words } = this;
    const answer = await fetch(`sheet.html?language=${words.language}`);
    if (!answer.ok) return;
    // Its own styles are for the printed sheet; the page may hold none, and must not even read them.
    const text = (await answer.text()).replace(/<style[\s\S]*?<\/style>/g, "");
    const sheet = new DOMParser().parseFromString(text, "text/html");
    for (const style of sheet.querySelectorAll("style, script, link, meta, title")) style.remove();
    this.closed = false;
    this.box.replaceChildren(make("div", { class: "row next" }, ...this.keys(), this.key("close_sheet", words.label("close"), () => this.close())), make("article", {}, ...sheet.body.childNodes));
    this.box.hidden = false;
    this.box.scrollTop = 0;
    reveal(this.box);
    this.box.focus({ preventScroll: true });
  }

  close() {
    this.closed = true;
    this.box.hidden = true;
  }

  /** What may come after the hand-in. */
  keys() {
    const { now, words, line, scene } = this;
    const acts = now.role === "trainer" || now.has_panel;
    if (!acts) return [];
    const again = this.key("again", words.label("again"), () => line.say({ attempt: "" }));
    return scene.next ? [again, this.key("next scene", words.label("next_scene"), () => line.say({ attempt: scene.next }))] : [again];
  }

  key(name, text, act) {
    const made = make("button", { type: "button", "data-key": name }, text);
    act_on(made, act);
    return made;
  }
}
