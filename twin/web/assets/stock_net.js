// What the stock is drawn on: vertices in the middles of cells, a rim of vertices on the blank's edge, and
// the side that hangs from it. Lengths are cells of the height map; heights come later, from its texture.

import * as THREE from "./three/three.module.js";

/** The blank's edge in cells: its middle, half of its size, whether it is a circle, and the radius of its bore. */
export function edge_of({ origin, cell, outline }) {
  return { center: outline.center.map((value, i) => (value - origin[i]) / cell), half: outline.half.map((value) => value / cell), round: outline.round, bore: outline.bore / cell };
}

/**
 * A vertex every few cells. Attributes in addition to "position" (where it is drawn; z is 0): "at", where its colour is
 * looked up; "source", the cell that gives its height (negative: the underside) and 1 on the rim, whose height
 * is the least around; "outward", which way the side looks (0: it is no side).
 */
export function stock_net(grid, step) {
  const edge = edge_of(grid), { rows, columns } = grid;
  const xs = lines(columns, step), ys = lines(rows, step), width = xs.length;
  const vertices = ys.flatMap((y, j) => xs.map((x, i) => {
    const within = i > 0 && j > 0 && i < width - 1 && j < ys.length - 1 && inside(edge, x, y);
    return within ? { x, y, source: [x, y], rim: false } : rim_vertex(edge, grid, step, x, y);
  }));
  const faces = [], sides = [];
  const square = (i, j) => {
    if (i < 0 || j < 0 || i >= width - 1 || j >= ys.length - 1) return null;
    const corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(([right, up]) => (j + up) * width + i + right);
    const all = corners.map((corner) => vertices[corner]);
    return all.every((vertex) => vertex) && !all.every((vertex) => vertex.rim) ? corners : null;
  };
  for (let j = 0; j < ys.length - 1; j++) {
    for (let i = 0; i < width - 1; i++) {
      const corners = square(i, j);
      if (!corners) continue;
      faces.push(corners[0], corners[1], corners[2], corners[0], corners[2], corners[3]);
      [[0, -1], [1, 0], [0, 1], [-1, 0]].forEach(([right, up], k) => {
        if (!square(i + right, j + up)) sides.push([corners[k], corners[(k + 1) % 4]]);
      });
    }
  }
  return geometry(vertices, faces, sides);
}

function lines(count, step) {
  const within = Array.from({ length: Math.ceil(count / step) }, (_, i) => i * step);
  return [-step, ...within, within.at(-1) + step];
}

function inside({ center, half, round, bore }, x, y) {
  const across = x - center[0], along = y - center[1], distance = Math.hypot(across, along);
  return round ? distance <= half[0] && distance >= bore : Math.abs(across) <= half[0] && Math.abs(along) <= half[1];
}

/** A vertex outside of the blank, moved onto its edge, with the height of the nearest one inside; null: none is near. */
function rim_vertex(edge, { rows, columns }, step, x, y) {
  const { center, half, round, bore } = edge;
  let [across, along] = [x - center[0], y - center[1]];
  if (round) {
    const distance = Math.max(Math.hypot(across, along), 1e-9), factor = Math.min(Math.max(distance, bore), half[0]) / distance;
    [across, along] = [across * factor, along * factor];
  } else {
    [across, along] = [[across, half[0]], [along, half[1]]].map(([value, most]) => Math.min(Math.max(value, -most), most));
  }
  const [to_x, to_y] = [center[0] + across, center[1] + along];
  let best = null, least = Infinity;
  for (const up of [-step, 0, step]) {
    for (const right of [-step, 0, step]) {
      const [from_x, from_y] = [x + right, y + up], away = Math.hypot(from_x - to_x, from_y - to_y);
      if (from_x < 0 || from_y < 0 || from_x >= columns || from_y >= rows || away >= least || !inside(edge, from_x, from_y)) continue;
      [best, least] = [[from_x, from_y], away];
    }
  }
  return best && { x: to_x, y: to_y, source: best, rim: true };
}

function geometry(vertices, faces, sides) {
  const position = [], at = [], source = [], outward = [];
  const add = (vertex, from, way) => {
    position.push(vertex?.x ?? 0, vertex?.y ?? 0, 0);
    at.push(vertex?.x ?? 0, vertex?.y ?? 0);
    source.push(...from, vertex?.rim ? 1 : 0);
    outward.push(...way);
    return position.length / 3 - 1;
  };
  for (const vertex of vertices) add(vertex, vertex?.source ?? [-1, -1], [0, 0]);
  for (const [a, b] of sides.map((ends) => ends.map((end) => vertices[end]))) {
    const length = Math.max(Math.hypot(b.x - a.x, b.y - a.y), 1e-9), way = [(b.y - a.y) / length, (a.x - b.x) / length];
    const [top_a, top_b, low_a, low_b] = [add(a, a.source, way), add(b, b.source, way), add(a, [-1, -1], way), add(b, [-1, -1], way)];
    faces.push(top_b, top_a, low_a, top_b, low_a, low_b);
  }
  const made = new THREE.BufferGeometry();
  [["position", position, 3], ["at", at, 2], ["source", source, 3], ["outward", outward, 2]].forEach(([name, values, size]) => made.setAttribute(name, new THREE.Float32BufferAttribute(values, size)));
  made.setIndex(faces);
  return made;
}
