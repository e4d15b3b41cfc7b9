// The stock: a height map as a smooth surface. Its shading is reckoned from the heights of the cells
// themselves, so that a small step shows however coarse the drawn net is.

import * as THREE from "./three/three.module.js";
import { TOOL_COLOURS } from "./tool_colours.js";

const RAW = new THREE.Color(0.25, 0.27, 0.3);
const CUT = new THREE.Color(0.72, 0.74, 0.77);
const SECTION = 0xd9822b;

const VERTEX_PARS = `
uniform sampler2D heights;
uniform vec2 cells;
varying vec2 cell;
float stored(ivec2 at) {
  if (at.x < 0 || at.y < 0 || at.x >= int(cells.x) || at.y >= int(cells.y)) return 0.0;
  return texelFetch(heights, at, 0).r;
}
`;

const FRAGMENT_PARS = `
uniform sampler2D heights;
uniform sampler2D tools;
uniform bool byTool;
uniform vec3 toolColours[${TOOL_COLOURS.length}];
uniform vec2 cells;
uniform float cellSize;
uniform float blank;
uniform vec3 rawColour;
uniform vec3 cutColour;
uniform mat3 normalMatrix;
varying vec2 cell;
float stored(ivec2 at) {
  return texelFetch(heights, clamp(at, ivec2(0), ivec2(cells) - 1), 0).r;
}
float smoothly(vec2 at) {
  vec2 low = floor(at), share = at - low;
  ivec2 i = ivec2(low);
  return mix(mix(stored(i), stored(i + ivec2(1, 0)), share.x),
             mix(stored(i + ivec2(0, 1)), stored(i + ivec2(1, 1)), share.x), share.y);
}
`;

const COLOUR = `
  float here = smoothly(cell);
  ivec2 nearest = ivec2(floor(cell + 0.5));
  float lowest = 1.0, around = 0.0;
  for (int i = 0; i < 8; i++) {
    float turn = 0.785398 * float(i);
    ivec2 way = ivec2(round(vec2(cos(turn), sin(turn)) * 1.4));
    float beside = stored(nearest + way);
    if (beside > 0.0) lowest = min(lowest, beside);
    around += stored(nearest + way * 5);
  }
  if (stored(nearest) > 0.0) lowest = min(lowest, stored(nearest));
  float machined = step(lowest, 1.0 - 0.004 / blank);
  float sunk = clamp((around / 8.0 - here) * blank / 6.0, 0.0, 1.0);
  vec3 cutBy = cutColour;
  if (byTool) {
    int tool = int(255.0 * texelFetch(tools, clamp(nearest, ivec2(0), ivec2(cells) - 1), 0).r + 0.5);
    if (tool > 0) cutBy = toolColours[(tool - 1) % ${TOOL_COLOURS.length}];
  }
  diffuseColor.rgb = mix(rawColour, cutBy, machined) * (1.0 - 0.55 * sunk);
`;

const NORMAL = `
  vec2 slope = vec2(smoothly(cell + vec2(0.6, 0.0)) - smoothly(cell - vec2(0.6, 0.0)),
                    smoothly(cell + vec2(0.0, 0.6)) - smoothly(cell - vec2(0.0, 0.6))) * blank / (1.2 * cellSize);
  float rim = max(max(-cell.x, cell.x - cells.x + 1.0), max(-cell.y, cell.y - cells.y + 1.0));
  vec3 upright = vec3(-slope, 1.0);
  if (rim > 0.02) upright = vec3(cell.x < 0.0 ? -1.0 : cell.x > cells.x - 1.0 ? 1.0 : 0.0,
                                 cell.y < 0.0 ? -1.0 : cell.y > cells.y - 1.0 ? 1.0 : 0.0, 0.0);
  vec3 normal = normalize(normalMatrix * normalize(upright));
  vec3 nonPerturbedNormal = normal;
`;

export class Stock {
  /** grid: origin, cell, rows, columns, bottom, top [mm]; step: cells between two drawn vertices; fine: it gleams. */
  constructor(grid, step, fine) {
    this.grid = grid;
    const { rows, columns, cell, bottom, top } = grid;
    this.shares = new Float32Array(rows * columns).fill(1);
    this.texture = new THREE.DataTexture(this.shares, columns, rows, THREE.RedFormat, THREE.FloatType);
    this.texture.needsUpdate = true;
    this.by = new Uint8Array(rows * columns);
    this.tools = new THREE.DataTexture(this.by, columns, rows, THREE.RedFormat, THREE.UnsignedByteType);
    this.tools.unpackAlignment = 1;
    this.tools.needsUpdate = true;
    this.byTool = { value: false };
    const uniforms = {
      tools: { value: this.tools }, byTool: this.byTool, toolColours: { value: TOOL_COLOURS.map((colour) => new THREE.Color(colour)) },
      heights: { value: this.texture }, cells: { value: new THREE.Vector2(columns, rows) },
      cellSize: { value: cell }, blank: { value: top - bottom }, rawColour: { value: RAW }, cutColour: { value: CUT },
    };
    const material = fine ? new THREE.MeshStandardMaterial({ metalness: 0.35, roughness: 0.42 }) : new THREE.MeshLambertMaterial();
    material.side = THREE.DoubleSide;
    material.onBeforeCompile = (shader) => {
      Object.assign(shader.uniforms, uniforms);
      shader.vertexShader = shader.vertexShader
        .replace("#include <common>", `#include <common>\n${VERTEX_PARS}`)
        .replace("#include <begin_vertex>", `
          cell = position.xy;
          vec3 transformed = vec3(clamp(position.xy, vec2(-0.5), cells - 0.5), position.z);
          bool outside = any(lessThan(position.xy, vec2(-0.75))) || any(greaterThan(position.xy, cells - 0.25));
          transformed.z = outside ? 0.0 : stored(ivec2(clamp(floor(position.xy + 0.5), vec2(0.0), cells - 1.0)));
          transformed = vec3(transformed.xy * ${cell.toFixed(6)}, transformed.z * ${(top - bottom).toFixed(6)});`);
      shader.fragmentShader = shader.fragmentShader
        .replace("#include <common>", `#include <common>\n${FRAGMENT_PARS}`)
        .replace("#include <color_fragment>", COLOUR)
        .replace("#include <normal_fragment_begin>", `float faceDirection = gl_FrontFacing ? 1.0 : -1.0;\n${NORMAL}`)
        .replace("#include <clipping_planes_fragment>", "#include <clipping_planes_fragment>\nif (smoothly(clamp(cell, vec2(0.0), cells - 1.0)) <= 0.0005) discard;");
    };
    this.mesh = new THREE.Mesh(net(rows, columns, step), material);
    this.mesh.frustumCulled = false;
    this.mesh.position.set(grid.origin[0], grid.origin[1], bottom);
    this.face = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshBasicMaterial({ color: SECTION, side: THREE.DoubleSide, toneMapped: false }));
    this.face.frustumCulled = this.face.visible = false;
    this.cut = null;
  }

  /** Height of the part at a place of its frame [mm]; below its underside outside of it. */
  height(x, y) {
    const { origin, cell, rows, columns, bottom, top } = this.grid;
    const column = Math.round((x - origin[0]) / cell), row = Math.round((y - origin[1]) / cell);
    if (row < 0 || column < 0 || row >= rows || column >= columns) return -Infinity;
    const share = this.shares[row * columns + column];
    return share > 0 ? bottom + share * (top - bottom) : -Infinity;
  }

  /** Cut the part open at a share of its width, in "x" or "y"; null: it is whole. Returns the plane in the part's frame. */
  section(axis, share) {
    const { origin, cell, rows, columns } = this.grid, along = axis === "x" ? columns : rows;
    this.cut = axis ? { axis, number: Math.round(share * (along - 1)) } : null;
    this.face.visible = !!axis;
    if (!axis) return null;
    this.fill_section();
    const at = (axis === "x" ? origin[0] : origin[1]) + this.cut.number * cell;
    return axis === "x" ? new THREE.Plane(new THREE.Vector3(-1, 0, 0), at) : new THREE.Plane(new THREE.Vector3(0, 1, 0), -at);
  }

  /** The face of the section: a strip from the part's underside to its height. */
  fill_section() {
    if (!this.cut) return;
    const { origin, cell, rows, columns, bottom, top } = this.grid, { axis, number } = this.cut, count = axis === "x" ? rows : columns;
    const places = [], faces = [];
    for (let i = 0; i < count; i++) {
      const [row, column] = axis === "x" ? [i, number] : [number, i], share = this.shares[row * columns + column];
      const [x, y] = [origin[0] + column * cell, origin[1] + row * cell];
      places.push(x, y, bottom, x, y, bottom + share * (top - bottom));
      if (i && share > 0 && places[6 * i - 1] > bottom) faces.push(2 * i - 2, 2 * i, 2 * i + 1, 2 * i - 2, 2 * i + 1, 2 * i - 1);
    }
    this.face.geometry.dispose();
    this.face.geometry = new THREE.BufferGeometry();
    this.face.geometry.setAttribute("position", new THREE.Float32BufferAttribute(places, 3));
    this.face.geometry.setIndex(faces);
  }

  /** Take over the heights of some cells, and who cut them; returns what they were. */
  put(patch) {
    const { columns } = this.grid;
    const before = new Uint16Array(patch.levels.length), by = patch.tools && new Uint8Array(patch.tools.length);
    for (let row = 0; row < patch.rows; row++) {
      const to = (patch.row + row) * columns + patch.column;
      const from = row * patch.columns;
      for (let i = 0; i < patch.columns; i++) {
        before[from + i] = Math.round(65535 * this.shares[to + i]);
        this.shares[to + i] = patch.levels[from + i] / 65535;
        if (!by) continue;
        by[from + i] = this.by[to + i];
        this.by[to + i] = patch.tools[from + i];
      }
    }
    this.texture.needsUpdate = this.tools.needsUpdate = true;
    this.fill_section();
    return { levels: before, tools: by };
  }
}

/** Vertices every few cells, with a rim outside the blank from which its sides hang. */
function net(rows, columns, step) {
  const places = (count) => [-1, -0.5, ...Array.from({ length: Math.floor((count - 1) / step) }, (_, i) => i * step), count - 1, count - 0.5, count];
  const xs = places(columns), ys = places(rows);
  const points = new Float32Array(xs.length * ys.length * 3);
  ys.forEach((y, j) => xs.forEach((x, i) => points.set([x, y, 0], 3 * (j * xs.length + i))));
  const faces = new Uint32Array((xs.length - 1) * (ys.length - 1) * 6);
  let at = 0;
  for (let j = 0; j < ys.length - 1; j++) {
    for (let i = 0; i < xs.length - 1; i++) {
      const a = j * xs.length + i, b = a + xs.length;
      faces.set([a, a + 1, b + 1, a, b + 1, b], at);
      at += 6;
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(points, 3));
  geometry.setIndex(new THREE.BufferAttribute(faces, 1));
  return geometry;
}
