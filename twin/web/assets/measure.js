// Measures the part by two places that are pointed at.

import * as THREE from "./three/three.module.js";

const CROSS_MM = 2;

export class Measure {
  constructor() {
    this.places = [];
    this.lines = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: 0xff3df2, depthTest: false, transparent: true, toneMapped: false }));
    this.lines.frustumCulled = false;
    this.lines.renderOrder = 2;
  }

  /** Point at the part: -1 to 1 to the right and upwards. Returns the places so far, in the part's frame [mm]. */
  point(machine, camera, [x, y]) {
    const near = machine.part.worldToLocal(new THREE.Vector3(x, y, -1).unproject(camera)), far = machine.part.worldToLocal(new THREE.Vector3(x, y, 1).unproject(camera));
    const way = far.sub(near).normalize();
    const found = machine.stock ? hit(machine.stock, near, way) : hit_mesh(machine, near, way);
    if (found) this.places = this.places.length === 1 ? [...this.places, found] : [found];
    this.draw();
    return this.places.map((place) => place.toArray());
  }

  clear() {
    this.places = [];
    this.draw();
  }

  draw() {
    const ends = this.places.flatMap((place) => [[1, 0, 0], [0, 1, 0], [0, 0, 1]].flatMap((way) => [-1, 1].flatMap((sign) => place.toArray().map((value, i) => value + sign * CROSS_MM * way[i]))));
    if (this.places.length === 2) ends.push(...this.places[0].toArray(), ...this.places[1].toArray());
    this.lines.geometry.setAttribute("position", new THREE.Float32BufferAttribute(ends, 3));
  }
}

/** Where a ray comes first to a part that is drawn as a mesh, and was not cut away by the section; null: it passes by. */
function hit_mesh(machine, from, way) {
  const meshes = machine.faces_of_part.filter((mesh) => mesh.isMesh);
  const world = new THREE.Raycaster(machine.part.localToWorld(from.clone()), way.clone().transformDirection(machine.part.matrixWorld));
  const shown = ({ object, point }) => (object.material.clippingPlanes ?? []).every((plane) => plane.distanceToPoint(point) >= 0);
  const found = world.intersectObjects(meshes, false).find(shown);
  return found ? machine.part.worldToLocal(found.point.clone()) : null;
}

/** Where a ray comes to the part first; null: it passes by. */
function hit(stock, from, way) {
  const { origin, cell, rows, columns, bottom, top } = stock.grid;
  const box = new THREE.Box3(new THREE.Vector3(origin[0] - cell, origin[1] - cell, bottom), new THREE.Vector3(origin[0] + columns * cell, origin[1] + rows * cell, top + cell));
  const entry = new THREE.Ray(from, way).intersectBox(box, new THREE.Vector3());
  if (!entry) return null;
  const inside = ({ x, y, z }) => z <= stock.height(x, y) && z >= bottom && !(stock.cut && beyond(stock, x, y));
  const step = 0.5 * cell, most = box.getSize(new THREE.Vector3()).length();
  for (let gone = 0; gone <= most; gone += step) {
    const place = entry.clone().addScaledVector(way, gone);
    if (!inside(place)) continue;
    let [out, within] = [Math.max(0, gone - step), gone];
    for (let i = 0; i < 20; i++) {
      const middle = 0.5 * (out + within);
      if (inside(entry.clone().addScaledVector(way, middle))) within = middle;
      else out = middle;
    }
    return entry.addScaledVector(way, within);
  }
  return null;
}

/** Whether a place was taken away by the section. */
function beyond({ cut, grid }, x, y) {
  return cut.axis === "x" ? x > grid.origin[0] + cut.number * grid.cell : y < grid.origin[1] + cut.number * grid.cell;
}
