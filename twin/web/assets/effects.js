// What flies and flows about the tool: chips, coolant, and the way that its tip has gone.

import * as THREE from "./three/three.module.js";

const CHIPS = 160;
const DROPS = 140;
const TRAIL = 60000;
const GRAVITY = -9810;

/** Small bright bits, in millimetres about the tip, that fly off while material is cut. */
export class Chips {
  constructor(colour, size) {
    this.count = 0;
    this.places = new Float32Array(CHIPS * 3).fill(1e6);
    this.speeds = new Float32Array(CHIPS * 3);
    this.left = new Float32Array(CHIPS);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(this.places, 3));
    this.points = new THREE.Points(geometry, new THREE.PointsMaterial({ color: colour, size, sizeAttenuation: true }));
    this.points.frustumCulled = false;
  }

  /** Let time go on; returns whether anything is still flying. */
  step(seconds, cutting, radius) {
    for (let n = 0; n < (cutting ? 5 : 0); n++) {
      const i = this.count++ % CHIPS, turn = 2 * Math.PI * Math.random(), fast = 250 + 500 * Math.random();
      this.places.set([radius * Math.cos(turn), radius * Math.sin(turn), 1], 3 * i);
      this.speeds.set([-fast * Math.sin(turn), fast * Math.cos(turn), 150 + 500 * Math.random()], 3 * i);
      this.left[i] = 0.35;
    }
    let flying = false;
    for (let i = 0; i < CHIPS; i++) {
      if (this.left[i] <= 0) continue;
      flying = true;
      this.left[i] -= seconds;
      this.speeds[3 * i + 2] += GRAVITY * seconds;
      for (let k = 0; k < 3; k++) this.places[3 * i + k] = this.left[i] > 0 ? this.places[3 * i + k] + this.speeds[3 * i + k] * seconds : 1e6;
    }
    if (flying) this.points.geometry.attributes.position.needsUpdate = true;
    return flying;
  }
}

/** Two jets from beside the spindle to the tip, in millimetres about the tip. */
export class Coolant {
  constructor(length) {
    this.places = new Float32Array(DROPS * 3);
    this.share = Float32Array.from({ length: DROPS }, () => Math.random());
    this.length = length;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(this.places, 3));
    this.points = new THREE.Points(geometry, new THREE.PointsMaterial({ color: 0x9fd8ff, size: 0.0016, transparent: true, opacity: 0.75 }));
    this.points.frustumCulled = false;
  }

  step(seconds, on) {
    this.points.visible = on;
    if (!on) return;
    for (let i = 0; i < DROPS; i++) {
      const share = this.share[i] = (this.share[i] + 5 * seconds) % 1;
      const side = i % 2 ? 1 : -1, off = 1 - share, spread = 3 * share;
      this.places.set([
        side * 38 * off + spread * Math.sin(91.7 * i), -30 * off + spread * Math.cos(57.3 * i), 0.9 * this.length * off * (0.55 + 0.45 * off),
      ], 3 * i);
    }
    this.points.geometry.attributes.position.needsUpdate = true;
  }
}

/** The way of the tip over the part, in the part's frame [mm]. */
export class Trail {
  constructor() {
    this.places = new Float32Array(TRAIL * 3);
    this.length = 0;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(this.places, 3));
    geometry.setDrawRange(0, 0);
    this.line = new THREE.Line(geometry, new THREE.LineBasicMaterial({ color: 0xff8a1f }));
    this.line.frustumCulled = false;
  }

  add(tip) {
    const at = 3 * (this.length - 1), last = this.places;
    if (this.length && Math.hypot(tip[0] - last[at], tip[1] - last[at + 1], tip[2] - last[at + 2]) < 0.05) return;
    if (this.length === TRAIL) {
      this.places.copyWithin(0, 3 * TRAIL / 2);
      this.length = TRAIL / 2;
    }
    this.places.set(tip, 3 * this.length++);
    this.line.geometry.setDrawRange(0, this.length);
    this.line.geometry.attributes.position.needsUpdate = true;
  }

  clear() {
    this.length = 0;
    this.line.geometry.setDrawRange(0, 0);
  }
}
