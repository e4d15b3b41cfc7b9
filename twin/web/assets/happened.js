// What a crash and a break look like: the bodies that met in red, a mark at the place, the tool without its end.

import * as THREE from "./three/three.module.js";

const RED = 0xff2a1f;
const RING_SHARE = 0.06; // Radius of the mark, as a share of the camera's distance.
const BREAKS_ABOVE = 1.3; // Diameters of the tool above its tip where it breaks.
const LEANS = 0.55; // Of the face of a break.

/** Shows what stopped a machine, until something else is said. */
export class Happened {
  constructor() {
    this.ring = new THREE.Mesh(new THREE.RingGeometry(0.86, 1, 48), new THREE.MeshBasicMaterial({ color: RED, side: THREE.DoubleSide, depthTest: false, transparent: true, toneMapped: false }));
    this.ring.frustumCulled = this.ring.visible = false;
    this.ring.renderOrder = 2;
    this.red = new THREE.MeshBasicMaterial({ color: RED, transparent: true, opacity: 0.72, toneMapped: false, polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -8 });
    this.plane = new THREE.Plane();
    this.stub = new THREE.Mesh(new THREE.CylinderGeometry(1, 1, 1, 24), new THREE.MeshLambertMaterial({ color: 0x8d8778 }));
    this.stub.visible = false;
    Object.assign(this, { given: null, painted: [], broken: false });
  }

  /** Put it into a machine that was just set up. */
  enter(machine) {
    machine.part.add(this.stub);
    machine.root.parent?.add(this.ring);
    this.painted = [];
    this.tell(machine, this.given, this.broken);
  }

  /** given: the bodies that met, and the place in the part's frame [mm]; broken: the tool in the spindle has lost its edge. */
  tell(machine, given, broken) {
    for (const [node, material, visible] of this.painted.splice(0)) Object.assign(node, { material, visible });
    Object.assign(this, { given, broken });
    this.ring.visible = !!given;
    if (given?.between.length) {
      const names = given.between.map((name) => THREE.PropertyBinding.sanitizeNodeName(`${machine.collision}${name} of`));
      const seen = given.between.map((name) => THREE.PropertyBinding.sanitizeNodeName(`${name} seen`));
      machine.root.traverse((node) => {
        const named = (node.name || node.parent?.name) ?? "";
        if (!node.isMesh || ![...names, ...seen].some((name) => named.startsWith(name) || node.parent?.name.startsWith(name))) return;
        this.painted.push([node, node.material, node.visible]);
        Object.assign(node, { material: this.red, visible: true });
      });
    }
    machine.cutter?.traverse((node) => {
      if (!node.isMesh) return;
      node.material.clippingPlanes = broken ? [this.plane] : null;
      node.material.needsUpdate = true;
    });
    this.stub.visible = broken && !!given?.place.length;
    if (!this.stub.visible) return;
    const { diameter } = machine.tool;
    this.stub.scale.set(diameter / 2, BREAKS_ABOVE * diameter, diameter / 2);
    this.stub.position.set(...given.place);
    this.stub.position.z += diameter / 2;
    this.stub.rotation.set(0, 0, 1.1);
  }

  /** Where it happened, in the world. */
  place(machine) {
    return machine.part.localToWorld(new THREE.Vector3(...this.given.place));
  }

  /** Before a picture: the mark faces the camera, the break goes with the tool. */
  follow(machine, camera) {
    if (this.ring.visible) {
      this.ring.position.copy(this.place(machine));
      this.ring.quaternion.copy(camera.quaternion);
      this.ring.scale.setScalar(RING_SHARE * camera.position.distanceTo(this.ring.position));
    }
    if (!this.broken) return;
    const tip = machine.tip.getWorldPosition(new THREE.Vector3());
    tip.z += 0.001 * BREAKS_ABOVE * machine.tool.diameter;
    this.plane.setFromNormalAndCoplanarPoint(new THREE.Vector3(LEANS, 0, 1).normalize(), tip);
  }
}
