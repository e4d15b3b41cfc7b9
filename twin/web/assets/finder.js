// The edge finder: a tip that gives way to the part, and a lamp about its body that is lit while it touches.

import * as THREE from "./three/three.module.js";

const TIP_HEIGHT = 16, LAMP_ABOVE = 19, LAMP_HEIGHT = 4, LAMP_OUT = 1.06; // [mm], and a share of the body's radius.
const STEEL = 0xdfe4ea, DARK = 0x4a1512, LIT = 0xff3a20;

export class Finder {
  /** tip: the frame of the tool's tip [mm]; drawn: the node of the cutter that it stands for; radius, body: of tip and body [mm]. */
  constructor(tip, drawn, radius, body) {
    const upright = (wide, height, material) => new THREE.Mesh(new THREE.CylinderGeometry(wide, wide, height, 40).rotateX(Math.PI / 2), material);
    this.tip = upright(radius, TIP_HEIGHT, new THREE.MeshLambertMaterial({ color: STEEL }));
    this.lamp = upright(LAMP_OUT * body, LAMP_HEIGHT, new THREE.MeshBasicMaterial({ color: DARK, toneMapped: false }));
    this.lamp.position.z = LAMP_ABOVE;
    this.shift = new THREE.Vector3();
    if (drawn) drawn.visible = false;
    tip.add(this.tip, this.lamp);
  }

  /** The tip is pushed aside, seen from the part [mm]; none: it is broken off. */
  push(shift) {
    this.tip.visible = shift.length > 0;
    this.shift.set(shift[0] ?? 0, shift[1] ?? 0, 0);
  }

  /** Before a picture: the tip stands where the part leaves it. */
  follow(part, tip, lit) {
    this.lamp.material.color.set(lit ? LIT : DARK);
    const [from, to] = [new THREE.Vector3(), this.shift.clone()].map((point) => tip.worldToLocal(part.localToWorld(point)));
    this.tip.position.copy(to.sub(from));
    this.tip.position.z += TIP_HEIGHT / 2;
  }
}
