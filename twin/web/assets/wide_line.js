// Lines of a width on the page: WebGL draws its own one dot wide, whatever it is told.

import * as THREE from "./three/three.module.js";

const VERTEX = `
  #include <common>
  #include <logdepthbuf_pars_vertex>
  attribute vec3 from, to, colour;
  uniform vec2 pixel;
  varying vec3 shade;
  void main() {
    vec4 one = projectionMatrix * modelViewMatrix * vec4(from, 1.0);
    vec4 other = projectionMatrix * modelViewMatrix * vec4(to, 1.0);
    // What lies behind the camera is cut off, or it would come out on the wrong side.
    float near = 1e-4;
    if (one.w < near && other.w > near) one = mix(other, one, (other.w - near) / (other.w - one.w));
    if (other.w < near && one.w > near) other = mix(one, other, (one.w - near) / (one.w - other.w));
    vec2 way = (other.xy / other.w - one.xy / one.w) / pixel;
    way = length(way) > 0.0 ? normalize(way) : vec2(1.0, 0.0);
    vec4 place = position.x < 0.0 ? one : other;
    // Half a width beyond each end closes the corners.
    place.xy += (sign(position.x) * way + position.y * vec2(-way.y, way.x)) * pixel * place.w;
    shade = colour;
    gl_Position = place;
  }`;
const FRAGMENT = `
  varying vec3 shade;
  void main() {
    gl_FragColor = vec4(shade, 1.0);
    #include <colorspace_fragment>
  }`;

/** A line through places, x, y and z each; every stretch has the colour of the place where it ends.
 *  The uniform `pixel` is its width over that of the canvas, and over its height. */
export function wideLine(places, colours) {
  const geometry = new THREE.InstancedBufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]), 3));
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  const ends = new THREE.InstancedInterleavedBuffer(places, 3, 1);
  geometry.setAttribute("from", new THREE.InterleavedBufferAttribute(ends, 3, 0));
  geometry.setAttribute("to", new THREE.InstancedBufferAttribute(places.subarray(3), 3));
  geometry.setAttribute("colour", new THREE.InstancedBufferAttribute(colours.subarray(3), 3));
  geometry.instanceCount = Math.max(0, places.length / 3 - 1);
  const material = new THREE.ShaderMaterial({
    vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms: { pixel: { value: new THREE.Vector2(0.01, 0.01) } }, side: THREE.DoubleSide,
  });
  const line = new THREE.Mesh(geometry, material);
  line.frustumCulled = false;
  return line;
}
