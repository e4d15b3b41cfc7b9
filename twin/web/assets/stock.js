// The stock: a height map as a smooth surface. Its shading is reckoned from the heights of the cells
// themselves, so that a small step shows however coarse the drawn net is.

import * as THREE from "./three/three.module.js";
import { edge_of, stock_net } from "./stock_net.js";
import { TOOL_COLOURS } from "./tool_colours.js";

const RAW = new THREE.Color(0.25, 0.27, 0.3);
const CUT = new THREE.Color(0.72, 0.74, 0.77);
const SECTION = 0xd9822b;

const VERTEX_PARS = `
uniform sampler2D heights;
uniform vec2 cells;
uniform vec4 circle;
attribute vec2 at;
attribute vec3 source;
attribute vec2 outward;
varying vec2 cell;
varying vec2 side;
float stored(ivec2 at) {
  if (at.x < 0 || at.y < 0 || at.x >= int(cells.x) || at.y >= int(cells.y)) return 0.0;
  return texelFetch(heights, at, 0).r;
}
float height_of(vec3 source) {
  ivec2 from = ivec2(round(source.xy));
  float least = stored(from);
  if (source.z < 0.5) return least;
  // A cut that leaves less than a cell takes some cells of the edge and leaves others: the edge is as low as any nearby.
  for (int i = -2; i < 3; i++) for (int j = -2; j < 3; j++) {
    if (circle.z > 0.0 && distance(vec2(from + ivec2(i, j)), circle.xy) < circle.z + 0.5) continue;
    float beside = stored(from + ivec2(i, j));
    if (beside > 0.0) least = min(least, beside);
  }
  return least;
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
uniform vec4 circle;
varying vec2 cell;
varying vec2 side;
float stored(ivec2 at) {
  return texelFetch(heights, clamp(at, ivec2(0), ivec2(cells) - 1), 0).r;
}
vec2 within(vec2 at) {
  if (circle.z <= 0.0) return at;
  vec2 from = at - circle.xy;
  float away = max(length(from), 1e-6);
  return circle.xy + from / away * clamp(away, circle.w, circle.z);
}
float smoothly(vec2 place) {
  vec2 at = within(place);
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
  vec3 upright = dot(side, side) > 0.25 ? vec3(side, 0.0) : vec3(-slope, 1.0);
  vec3 normal = normalize(normalMatrix * normalize(upright));
  vec3 nonPerturbedNormal = normal;
`;

export class Stock {
  /** grid: origin, cell, rows, columns, bottom, top, outline [mm]; step: cells between two drawn vertices; fine: it gleams. */
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
      circle: { value: circle_of(edge_of(grid)) },
      cellSize: { value: cell }, blank: { value: top - bottom }, rawColour: { value: RAW }, cutColour: { value: CUT },
    };
    const material = fine ? new THREE.MeshStandardMaterial({ metalness: 0.35, roughness: 0.42 }) : new THREE.MeshLambertMaterial();
    material.side = THREE.DoubleSide;
    material.onBeforeCompile = (shader) => {
      Object.assign(shader.uniforms, uniforms);
      shader.vertexShader = shader.vertexShader
        .replace("#include <common>", `#include <common>\n${VERTEX_PARS}`)
        .replace("#include <begin_vertex>", `
          cell = at;
          side = outward;
          vec3 transformed = vec3(position.xy * ${cell.toFixed(6)}, height_of(source) * ${(top - bottom).toFixed(6)});`);
      shader.fragmentShader = shader.fragmentShader
        .replace("#include <common>", `#include <common>\n${FRAGMENT_PARS}`)
        .replace("#include <color_fragment>", COLOUR)
        .replace("#include <normal_fragment_begin>", `float faceDirection = gl_FrontFacing ? 1.0 : -1.0;\n${NORMAL}`)
        .replace("#include <clipping_planes_fragment>", "#include <clipping_planes_fragment>\nif (dot(side, side) < 0.25 && smoothly(clamp(cell, vec2(0.0), cells - 1.0)) <= 0.0005) discard;");
    };
    this.mesh = new THREE.Mesh(stock_net(grid, step), material);
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

/** Middle, and the radii between which a round blank's cells are all its own; a negative one for others [cells]. */
function circle_of({ center, half, round, bore }) {
  return new THREE.Vector4(...center, round ? Math.max(half[0] - 1.5, 0.5) : -1, bore ? bore + 1.5 : 0);
}
