// Draws the machine on a thread of its own, so that the page is free to hear keys however slow the
// drawing is. It draws only when something has changed.

import * as THREE from "./three/three.module.js";
import { GLTFLoader } from "./three/GLTFLoader.js";
import { RoomEnvironment } from "./three/RoomEnvironment.js";
import { Chips, Coolant, Trail } from "./effects.js";
import { Finder } from "./finder.js";
import { Happened } from "./happened.js";
import { Measure } from "./measure.js";
import { PartMesh } from "./part_mesh.js";
import { Stock } from "./stock.js";
import { wideLine } from "./wide_line.js";
import { MESH, readMesh, readPatch, readState } from "./wire.js";

const SOFTWARE = /swiftshader|llvmpipe|software|basic render/i;
const BACKGROUND = 0x76838f, FLOOR = 0xa3aeb8;
const STILL_MS = 700; // Without a graphics card a view that is still for so long is drawn once as well as it can be.
const FASTEST_MS = 33;
const SLOW_MS = 120;
const DASH_MM = 2.5; // Of the dashes of a rapid, and between them.
const CLOSE_M = 0.34; // How near a crash is looked at.
const PATH_PX = 3; // Width of the path on the page.
const ABOVE_MM = 0.15; // What a path lies above the floor that it was cut into.

let renderer, scene, camera, key, base, moved = 0, sharp = false, most_dots = 1, fine, by_processor, size = [1, 1], dirty = true, busy = false, last = 0, pictures = 0, drawing = 0, dots = 1, slow = 0;
let machine = null, patches = Promise.resolve(), wanted = 0;
const orbit = { azimuth: -0.9, elevation: 0.42, distance: 2.4, target: new THREE.Vector3(0, 0, 1), follows: "part" };
const shown = { trail: true, stock: true, collision: false, by_tool: false };
const happened = new Happened(), measure = new Measure();
let section = { axis: null, share: 0.5 }, section_plane = null;
const section_in_world = new THREE.Plane();
const trail = new Trail();
trail.line.position.z = ABOVE_MM;
let path = null, pushed = [];
const preview = [];

function open({ canvas, width, height, ratio, address, quality }) {
  by_processor = drawn_by_processor();
  fine = quality === "fine" || (quality !== "plain" && !by_processor);
  renderer = new THREE.WebGLRenderer({ canvas, antialias: fine, powerPreference: "high-performance" });
  base = address;
  renderer.localClippingEnabled = true;
  renderer.toneMapping = THREE.ACESFilmicToneMapping;
  renderer.toneMappingExposure = 0.9;
  most_dots = ratio;
  dots = fine ? ratio : Math.min(ratio, 1);
  renderer.setPixelRatio(dots);
  scene = new THREE.Scene();
  scene.background = new THREE.Color(BACKGROUND);
  scene.fog = new THREE.Fog(BACKGROUND, 6, 14);
  camera = new THREE.PerspectiveCamera(34, 1, 0.01, 40);
  camera.up.set(0, 0, 1);
  light();
  resize([width, height]);
}

function drawn_by_processor() {
  const context = new OffscreenCanvas(1, 1).getContext("webgl2");
  const info = context?.getExtension("WEBGL_debug_renderer_info");
  return !info || SOFTWARE.test(context.getParameter(info.UNMASKED_RENDERER_WEBGL));
}

function light() {
  if (fine) {
    const maker = new THREE.PMREMGenerator(renderer);
    scene.environment = maker.fromScene(new RoomEnvironment(), 0.04).texture;
    scene.environmentIntensity = 0.38;
    scene.environmentRotation = new THREE.Euler(Math.PI / 2, 0, 0);
  } else {
    scene.add(new THREE.HemisphereLight(0xdfe9f5, 0x5a616a, 1.3));
  }
  renderer.shadowMap.enabled = true;
  key = new THREE.DirectionalLight(0xfff4e6, fine ? 2.2 : 1.5);
  key.position.set(-1.6, -2.4, 3.6);
  key.castShadow = fine;
  key.shadow.mapSize.set(2048, 2048);
  Object.assign(key.shadow.camera, { left: -1.4, right: 1.4, top: 1.4, bottom: -1.4, near: 0.5, far: 8 });
  key.shadow.bias = -0.0004;
  key.target.position.set(0, 0, 0.9);
  const rim = new THREE.DirectionalLight(0x9ec8ff, 0.9);
  rim.position.set(2.5, 2, 2);
  scene.add(key, key.target, rim);
  const floor = new THREE.Mesh(new THREE.CircleGeometry(9, 64), new THREE.MeshLambertMaterial({ color: FLOOR }));
  floor.receiveShadow = true;
  scene.add(floor);
}

function resize([width, height]) {
  size = [Math.max(1, width), Math.max(1, height)];
  renderer.setSize(size[0], size[1], false);
  camera.aspect = size[0] / size[1];
  camera.updateProjectionMatrix();
  dirty = true;
}

/** Fetch and set up the machine with a tool in its spindle. */
async function load(tool) {
  const mine = ++wanted;
  const described = await (await fetch(`${base}machine.json?tool=${tool}`)).json();
  const file = await (await fetch(`${base}machine.glb?tool=${tool}`)).arrayBuffer();
  const drawn = await new GLTFLoader().parseAsync(file, "");
  if (mine !== wanted) return;
  const first = machine === null;
  if (!first) scene.remove(machine.root);
  machine = assemble(described, drawn.scene);
  scene.add(machine.root);
  happened.enter(machine);
  cut_open();
  dirty = true;
  if (state) {
    move(state.machine);
    cut_until(state.time);
  }
  if (first) {
    look("start");
    postMessage({ ready: true, fine });
  }
}

function assemble(described, root) {
  const named = (name) => root.getObjectByName(THREE.PropertyBinding.sanitizeNodeName(name));
  const belongs = (node, prefix) => [node.name, node.parent?.name].some((name) => name?.startsWith(THREE.PropertyBinding.sanitizeNodeName(prefix)));
  const bodies = [], faces_of_part = [];
  root.traverse((node) => {
    if (node.isMesh) {
      node.castShadow = node.receiveShadow = true;
      if (!fine) node.material = matt(node.material);
      if (belongs(node, described.collision)) {
        node.material = new THREE.MeshBasicMaterial({ color: 0xff5544, wireframe: true });
        bodies.push(node);
      }
    }
  });
  const joints = described.joints.map((joint) => {
    const node = named(joint.body);
    return { ...joint, node, at: node.position.clone(), turned: node.quaternion.clone(), way: new THREE.Vector3(...joint.direction) };
  });
  const part = frame(described.part, named);
  const tip = frame(described.tip, named);
  const found = { root, joints, part, tip, bodies, faces_of_part, cutter: named(described.cutter), tool: described.tool, collision: described.collision, radius: described.tool.diameter / 2, stock: null, part_mesh: null };
  if (described.part_mesh) {
    found.part_mesh = machine?.part_mesh ?? new PartMesh(fine);
    found.faces_of_part.push(found.part_mesh.mesh);
    part.add(found.part_mesh.mesh);
  }
  if (described.stock) {
    found.stock = machine?.stock ?? new Stock(described.stock, by_processor ? 3 : 1, fine);
    part.add(found.stock.mesh, found.stock.face);
  }
  part.add(measure.lines);
  part.add(trail.line);
  if (described.finder) {
    found.finder = new Finder(tip, named(`${described.cutter} of ${described.cutter}`), found.radius, described.finder.body);
    found.finder.push(pushed);
  }
  if (path) part.add(path);
  if (preview.length) part.add(...preview);
  found.chips = new Chips(0xe8d9b0, 0.0014);
  found.coolant = new Coolant(described.tool.length);
  tip.add(found.chips.points, found.coolant.points);
  show(found);
  return found;
}

/** What a processor draws in half the time; without surroundings to mirror, metal would be black anyhow. */
function matt({ color, map, vertexColors, transparent, opacity, side }) {
  return new THREE.MeshLambertMaterial({ color, map, vertexColors, transparent, opacity, side });
}

function frame(place, named) {
  const group = new THREE.Group();
  group.matrixAutoUpdate = false;
  group.matrix.fromArray(place.matrix);
  named(place.body).add(group);
  return group;
}

function show(target) {
  if (!target) return;
  trail.line.visible = shown.trail;
  if (target.stock) {
    target.stock.mesh.visible = shown.stock;
    target.stock.byTool.value = shown.by_tool;
  }
  for (const face of target.faces_of_part) face.visible = shown.stock;
  target.part_mesh?.show(shown.by_tool);
  for (const body of target.bodies) body.visible = shown.collision;
  dirty = true;
}

/** Move the nodes to where the axes stand [mm or deg]. */
function move(machineCoordinates) {
  const turn = new THREE.Quaternion();
  machine.joints.forEach((joint, number) => {
    const way = machineCoordinates[number] * joint.scale;
    if (joint.slides) joint.node.position.copy(joint.at).addScaledVector(joint.way, way);
    else joint.node.quaternion.copy(joint.turned).multiply(turn.setFromAxisAngle(joint.way, way));
  });
}

let state = null;
function take(seen, follows = true) {
  const before = state;
  state = seen;
  if (!machine) return;
  if (before && state.time < before.time) trail.clear();
  if (follows) trail.add(state.tip);
  const still = before && before.machine.every((value, i) => Math.abs(value - state.machine[i]) < 1e-5);
  if (!still || state.turns || state.coolant || before.touches !== state.touches) dirty = true;
  move(state.machine);
}

function centre(what) {
  const point = new THREE.Vector3();
  machine.root.updateMatrixWorld(true);
  if (what === "tool") return machine.tip.getWorldPosition(point);
  if (what === "part") {
    if (machine.faces_of_part.length) return around_part().getCenter(point);
    const grid = machine.stock?.grid;
    if (!grid) return around_table().getCenter(point);
    point.set(grid.origin[0] + 0.5 * grid.cell * grid.columns, grid.origin[1] + 0.5 * grid.cell * grid.rows, grid.top);
    return machine.part.localToWorld(point);
  }
  return new THREE.Box3().setFromObject(machine.root).getCenter(point);
}

/** The box around what would carry a part, and what is clamped to it: where there is no stock, that is looked at. */
function around_table() {
  const box = new THREE.Box3();
  for (const node of machine.part.parent.children) if (node !== machine.part) box.expandByObject(node);
  return box;
}

/** The box around a part that is drawn as a mesh. */
function around_part() {
  const box = new THREE.Box3();
  for (const face of machine.faces_of_part) box.expandByObject(face);
  return box;
}

/** Choose a view by its name. */
function look(name) {
  if (!machine) return;
  const grid = machine.stock?.grid;
  const part = grid ? 0.001 * grid.cell * Math.hypot(grid.rows, grid.columns) : machine.faces_of_part.length ? around_part().getSize(new THREE.Vector3()).length() : 0.2;
  const views = {
    start: ["part", -1.12, 0.5, 5.5 * part], front: ["part", -Math.PI / 2, 0.12, 5.5 * part], top: ["part", -Math.PI / 2, 1.5533, 2.6 * part],
    tool: ["tool", -1.0, 0.35, 0.42], part: ["part", -1.05, 0.62, 3.0 * part], fit: ["fit", -1.05, 0.32, 6.2],
  };
  const [about, azimuth, elevation, distance] = views[name] ?? views.start;
  Object.assign(orbit, { azimuth, elevation, distance: distance * Math.max(1, 1.1 / camera.aspect), follows: about });
  orbit.target.copy(centre(about));
  dirty = true;
}

/** Cut the part open, or close it again. */
function cut_open() {
  const part = machine?.stock ?? machine?.part_mesh;
  if (!part) return;
  section_plane = part.section(section.axis, section.share);
  part.mesh.material.clippingPlanes = section_plane ? [section_in_world] : null;
  part.mesh.material.needsUpdate = true;
  dirty = true;
}

/** What stopped the machine: shown where it happened, and looked at once. */
function happen({ alarm, broken, look_there }) {
  if (!machine) {
    Object.assign(happened, { given: alarm, broken });
    return;
  }
  happened.tell(machine, alarm, broken);
  if (alarm && look_there) {
    orbit.target.copy(happened.place(machine));
    Object.assign(orbit, { follows: "", distance: CLOSE_M, elevation: Math.max(0.3, Math.min(0.7, orbit.elevation)) });
  }
  dirty = true;
}

function turn({ azimuth = 0, elevation = 0, zoom = 1, pan = [0, 0] }) {
  orbit.azimuth -= azimuth;
  orbit.elevation = Math.min(1.5533, Math.max(-0.25, orbit.elevation + elevation));
  orbit.distance = Math.min(12, Math.max(0.05, orbit.distance * zoom));
  if (pan[0] || pan[1]) {
    orbit.follows = "";
    const right = new THREE.Vector3().setFromMatrixColumn(camera.matrix, 0), up = new THREE.Vector3().setFromMatrixColumn(camera.matrix, 1);
    orbit.target.addScaledVector(right, -pan[0] * orbit.distance).addScaledVector(up, pan[1] * orbit.distance);
  }
  dirty = true;
}

function aim() {
  if (orbit.follows && orbit.follows !== "fit") orbit.target.lerp(centre(orbit.follows), 0.5);
  const level = orbit.distance * Math.cos(orbit.elevation);
  camera.position.set(
    orbit.target.x + level * Math.cos(orbit.azimuth), orbit.target.y + level * Math.sin(orbit.azimuth),
    Math.max(0.05, orbit.target.z + orbit.distance * Math.sin(orbit.elevation)),
  );
  // From above, what hangs over the part is left out.
  camera.near = orbit.elevation > 1.2 ? Math.max(0.05 * orbit.distance, orbit.distance - 0.12) : Math.max(0.005, 0.05 * orbit.distance);
  camera.updateProjectionMatrix();
  camera.lookAt(orbit.target);
}

/** One picture, if anything has changed. What draws slowly leaves the processor to the machine for twice as long. */
function draw() {
  setTimeout(draw, Math.max(FASTEST_MS, 2 * drawing));
  const now = performance.now();
  if (!machine) return;
  const seconds = Math.min(0.1, 0.001 * (now - last));
  last = now;
  if (state) {
    if (machine.chips.step(seconds, state.cutting && state.turns, machine.radius)) dirty = true;
    machine.coolant.step(seconds, state.coolant);
    if (state.turns && machine.cutter) machine.cutter.rotateZ(-14 * seconds);
  }
  const was_sharp = sharp;
  sharp = !dirty && !fine && (sharp || now - moved > STILL_MS);
  if (!dirty && sharp === was_sharp) return;
  if (dirty) moved = now;
  dirty = false;
  if (sharp !== was_sharp) refine();
  aim();
  happened.follow(machine, camera);
  machine.finder?.follow(machine.part, machine.tip, state?.touches);
  if (section_plane) section_in_world.copy(section_plane).applyMatrix4(machine.part.matrixWorld);
  const began = performance.now();
  renderer.render(scene, camera);
  pictures += 1;
  if (sharp) return;
  if (by_processor) wait_for_picture();
  drawing = performance.now() - began;
}

/** All dots and shadows for a view that is still; as many as can be drawn quickly for one that moves. */
function refine() {
  key.castShadow = fine || sharp;
  renderer.setPixelRatio(sharp ? Math.max(most_dots, dots) : dots);
  renderer.setSize(size[0], size[1], false);
}

setInterval(() => postMessage({ pictures, drawing_ms: drawing }), 1000);

/** What a processor draws slowly is drawn with fewer dots. */
function wait_for_picture() {
  const context = renderer.getContext();
  context.readPixels(0, 0, 1, 1, context.RGBA, context.UNSIGNED_BYTE, new Uint8Array(4));
  slow = drawing > SLOW_MS ? slow + 1 : 0;
  if (!fine && slow > 2 && dots > 0.6) {
    slow = 0;
    dots *= 0.8;
    refine();
    dirty = true;  // What was drawn is gone with the old size.
  }
}

/** The cuts of a run, in order of time; those that were done can be taken back. */
let cuts = [], done = 0;
function cut_until(time) {
  if (machine?.part_mesh) return mesh_until(time);
  if (!machine?.stock) return;
  while (done < cuts.length && cuts[done].time <= time) {
    cuts[done].before = machine.stock.put(cuts[done].patch);
    done += 1;
    dirty = true;
  }
  while (done > 0 && cuts[done - 1].time > time) {
    done -= 1;
    machine.stock.put({ ...cuts[done].patch, ...cuts[done].before });
    dirty = true;
  }
}

/** Lay the last mesh of a part that is not later than a time. */
function mesh_until(time) {
  let last = 0;
  while (last + 1 < cuts.length && cuts[last + 1].time <= time) last += 1;
  const laid = cuts[last]?.mesh;
  if (!laid || laid === mesh_laid) return;
  const first = !mesh_laid;
  machine.part_mesh.put(mesh_laid = laid);
  if (first) look("start");
  cut_open();
}
let mesh_laid = null;

/** The whole path of a run: places [mm] and colours of the stretches that end there. */
function drawPath({ places, colours }) {
  path = wideLine(places, colours);
  path.onBeforeRender = () => path.material.uniforms.pixel.value.set(PATH_PX / size[0], PATH_PX / size[1]);
  path.position.z = ABOVE_MM;
  machine?.part.add(path);
  dirty = true;
}

/** The way of a program that has not been run [mm]: feed in one line, rapids in another, dashed; seen through the part. */
function drawPreview(given) {
  for (const one of preview.splice(0)) {
    one.removeFromParent();
    one.geometry.dispose();
    one.material.dispose();
  }
  for (const [places, material] of given ? [[given.feed, new THREE.LineBasicMaterial({ color: 0x59e2ff })], [given.fast, new THREE.LineDashedMaterial({ color: 0xffa43d, dashSize: DASH_MM, gapSize: DASH_MM })]] : []) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(places, 3));
    Object.assign(material, { depthTest: false, transparent: true, toneMapped: false });
    const lines = new THREE.LineSegments(geometry, material);
    lines.computeLineDistances();
    lines.frustumCulled = false;
    lines.renderOrder = 1;
    preview.push(lines);
    machine?.part.add(lines);
  }
  dirty = true;
}

const heard = {
  open(given) { open(given); draw(); },
  load,
  state: (buffer) => take(readState(buffer)),
  moment(seen) { take(seen, false); cut_until(seen.time); },
  cuts: (given) => { cuts = given.map((one) => ({ ...one, before: null })); },
  patch(buffer) {
    // Inflated in parallel, put in their order.
    const of_mesh = new Uint8Array(buffer, 0, 1)[0] === MESH, read = of_mesh ? readMesh(buffer) : readPatch(buffer);
    patches = patches.then(async () => {
      const given = await read, first = of_mesh && !machine?.part_mesh?.by.length;
      (of_mesh ? machine?.part_mesh : machine?.stock)?.put(given);
      if (first) look("start");
      if (of_mesh) cut_open();
      dirty = true;
    }).catch((error) => postMessage({ failed: String(error) }));
  },
  path: drawPath,
  preview: drawPreview,
  size: resize,
  look,
  turn,
  happen,
  finder(shift) {
    pushed = shift;
    machine?.finder?.push(shift);
    dirty = true;
  },
  section(given) { section = given; cut_open(); },
  measure(where) {
    if (where) postMessage({ measured: machine ? measure.point(machine, camera, where) : [] });
    else measure.clear();
    dirty = true;
  },
  show(what) { Object.assign(shown, what); show(machine); if (path) path.visible = shown.trail; },
};

onmessage = async ({ data: [what, given] }) => {
  try {
    await heard[what](given);
  } catch (error) {
    postMessage({ failed: String(error?.message ?? error) });
  }
};
