"use strict";
// One cursor for all plots: hovering over a point of one marks the same instant in the others.
const run = JSON.parse(document.getElementById("run").textContent);
const plots = [...document.querySelectorAll("figure.hover")].map(figure => {
  const svg = figure.querySelector("svg"), overTime = figure.dataset.cursor === "time";
  const cursor = document.createElementNS(svg.namespaceURI, overTime ? "line" : "circle");
  cursor.setAttribute("class", "cursor");
  if (overTime) {
    cursor.setAttribute("y1", 0);
    cursor.setAttribute("y2", svg.viewBox.baseVal.height);
  } else cursor.setAttribute("r", 5);
  svg.append(cursor);
  const tip = document.createElement("div");
  tip.className = "tip";
  figure.append(tip);
  return { figure, svg, overTime, cursor, tip, places: JSON.parse(figure.dataset.places) };
});

const told = {
  error: i => `${run.error[i].toFixed(2)} µm`,
  following: i => run.axes.map(([name, unit], axis) => `${name} ${run.lag[i][axis]} ${unit}`).join("  "),
  speed: i => `${run.speed[i]} mm/min`,
};

function nearest(plot, x, y) {
  let best = 0, least = Infinity;
  plot.places.forEach(([px, py], index) => {
    const square = (px - x) ** 2 + (plot.overTime ? 0 : (py - y) ** 2);
    if (square < least) { least = square; best = index; }
  });
  return best;
}

function mark(plot, index) {
  const [x, y] = plot.places[index];
  const places = plot.overTime ? { x1: x, x2: x } : { cx: x, cy: y };
  for (const [name, value] of Object.entries(places)) plot.cursor.setAttribute(name, value);
  plot.cursor.style.visibility = "visible";
}

function tell(plot, index, scale, box) {
  const [x, y] = plot.places[index], { tip } = plot;
  const text = run.text[run.line[index]];
  tip.textContent = `line ${run.line[index]} · ${run.time[index].toFixed(3)} s · ` +
    told[plot.figure.dataset.tells](index) + (text ? `\n${text}` : "");
  tip.style.display = "block";
  tip.style.left = `${Math.max(0, Math.min(x * scale + 12, box.width - tip.offsetWidth))}px`;
  tip.style.top = `${Math.max(0, y * scale - tip.offsetHeight - 12)}px`;
}

for (const plot of plots) {
  plot.figure.addEventListener("pointermove", event => {
    const box = plot.svg.getBoundingClientRect();
    const scale = box.width / plot.svg.viewBox.baseVal.width;
    const index = nearest(plot, (event.clientX - box.left) / scale, (event.clientY - box.top) / scale);
    for (const other of plots) mark(other, index);
    tell(plot, index, scale, box);
  });
  plot.figure.addEventListener("pointerleave", () => {
    plot.tip.style.display = "none";
    for (const other of plots) other.cursor.style.visibility = "hidden";
  });
}
