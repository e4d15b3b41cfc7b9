// A part that is cut from any side: a mesh that is laid anew whenever the machine tells of it.

import * as THREE from "./three/three.module.js";
import { TOOL_COLOURS } from "./tool_colours.js";

const RAW = new THREE.Color(0.25, 0.27, 0.3), CUT = new THREE.Color(0.72, 0.74, 0.77);

export class PartMesh {
  /** fine: it gleams. */
  constructor(fine) {
    const given = { vertexColors: true, flatShading: true, side: THREE.DoubleSide };
    const material = fine ? new THREE.MeshStandardMaterial({ ...given, metalness: 0.35, roughness: 0.42 }) : new THREE.MeshLambertMaterial(given);
    this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
    this.mesh.castShadow = this.mesh.receiveShadow = true;
    Object.assign(this, { by: new Uint8Array(0), by_tool: false });
  }

  /** points [mm], corners of the triangles, and the tool that left each, 0 for the blank's own. */
  put({ points, corners, by }) {
    const places = new Float32Array(3 * corners.length);
    corners.forEach((corner, i) => places.set(points.subarray(3 * corner, 3 * corner + 3), 3 * i));
    this.mesh.geometry.dispose();
    this.mesh.geometry = new THREE.BufferGeometry();
    this.mesh.geometry.setAttribute("position", new THREE.BufferAttribute(places, 3));
    this.by = by;
    this.colour();
  }

  /** Surfaces in the tools' colours, or raw and cut. */
  show(by_tool) {
    if (this.by_tool === by_tool) return;
    this.by_tool = by_tool;
    this.colour();
  }

  colour() {
    const colours = new Float32Array(9 * this.by.length), of_tool = TOOL_COLOURS.map((colour) => new THREE.Color(colour));
    this.by.forEach((tool, i) => {
      const { r, g, b } = !tool ? RAW : this.by_tool ? of_tool[(tool - 1) % of_tool.length] : CUT;
      for (let corner = 0; corner < 3; corner++) colours.set([r, g, b], 9 * i + 3 * corner);
    });
    this.mesh.geometry.setAttribute("color", new THREE.BufferAttribute(colours, 3));
  }

  /** Cut the part open at a share of its width, in "x" or "y"; returns the plane in the part's frame, null: it is whole. */
  section(axis, share) {
    if (!axis || !this.by.length) return null;
    this.mesh.geometry.computeBoundingBox();
    const { min, max } = this.mesh.geometry.boundingBox, at = min[axis] + share * (max[axis] - min[axis]);
    return axis === "x" ? new THREE.Plane(new THREE.Vector3(-1, 0, 0), at) : new THREE.Plane(new THREE.Vector3(0, 1, 0), -at);
  }
}
