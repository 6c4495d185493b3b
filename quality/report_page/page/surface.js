// Triangles as the view draws them: each with its own value, colours by a table, the cut and the edges in the shader.
import * as THREE from 'three';

const vertex = `
attribute float value;
attribute float mark;
varying float v_value, v_mark;
varying vec3 v_place, v_corner, v_eye;
void main() {
  v_value = value;
  v_mark = mark;
  v_place = position;
  int corner = gl_VertexID % 3;
  v_corner = vec3(corner == 0, corner == 1, corner == 2);
  vec4 eye = modelViewMatrix * vec4(position, 1.0);
  v_eye = eye.xyz;
  gl_Position = projectionMatrix * eye;
}`;

const fragment = `
uniform sampler2D table;
uniform vec2 range;
uniform vec3 neutral, chosen;
uniform vec4 cut;
uniform float opacity, edges, dimmed, lit;
varying float v_value, v_mark;
varying vec3 v_place, v_corner, v_eye;
void main() {
  if (dot(cut.xyz, v_place) > cut.w) discard;
  vec3 colour = neutral;
  if (!(v_value < -1e29)) colour = texture2D(table, vec2(clamp((v_value - range.x) / (range.y - range.x), 0.002, 0.998), 0.5)).rgb;
  if (dimmed > 0.0) colour = mix(colour, neutral, v_mark > 0.5 ? 0.0 : dimmed);
  if (v_mark > 0.5) colour = chosen;
  vec3 normal = normalize(cross(dFdx(v_eye), dFdy(v_eye)));
  float light = mix(1.0, 0.58 + 0.46 * abs(dot(normal, normalize(vec3(0.25, 0.45, 1.0)))), lit);
  if (!gl_FrontFacing && lit > 0.0) light *= 0.55;
  vec3 near = v_corner / fwidth(v_corner);
  float edge = edges * (1.0 - smoothstep(0.2, 1.0, min(min(near.x, near.y), near.z)));
  gl_FragColor = vec4(mix(colour * light, colour * light * 0.45, edge * 0.55), opacity);
}`;

export function texture(table) {
  const image = new THREE.DataTexture(table, table.length / 4, 1, THREE.RGBAFormat);
  image.minFilter = image.magFilter = THREE.NearestFilter;
  image.needsUpdate = true;
  return image;
}

const none = -1e30;  // in an attribute, NaN need not arrive

export class Surface {
  // `corners`: nine numbers to a triangle.
  constructor(corners, { neutral, chosen, lit = 1 }) {
    this.corners = corners;
    this.count = corners.length / 9;
    this.geometry = new THREE.BufferGeometry();
    this.geometry.setAttribute('position', new THREE.BufferAttribute(corners, 3));
    this.geometry.setAttribute('value', new THREE.BufferAttribute(new Float32Array(3 * this.count).fill(none), 1));
    this.geometry.setAttribute('mark', new THREE.BufferAttribute(new Float32Array(3 * this.count), 1));
    this.geometry.boundingSphere = new THREE.Sphere(new THREE.Vector3(), 1);
    const colour = (c) => new THREE.Vector3(...c.map((x) => x / 255));
    this.uniforms = {
      table: { value: texture(new Uint8Array(4)) }, range: { value: new THREE.Vector2(0, 1) },
      neutral: { value: colour(neutral) }, chosen: { value: colour(chosen) },
      cut: { value: new THREE.Vector4(0, 0, 0, 1) }, opacity: { value: 1 }, edges: { value: 1 }, dimmed: { value: 0 },
      lit: { value: lit },
    };
    this.material = new THREE.ShaderMaterial({ uniforms: this.uniforms, vertexShader: vertex, fragmentShader: fragment, side: THREE.DoubleSide });
    this.mesh = new THREE.Mesh(this.geometry, this.material);
    this.mesh.frustumCulled = false;
  }

  colour(table, low, high, ofTriangles) {
    this.uniforms.table.value.dispose();
    this.uniforms.table.value = texture(table);
    this.scale(low, high);
    const attribute = this.geometry.getAttribute('value');
    for (let i = 0; i < this.count; ++i) {
      const value = ofTriangles && !Number.isNaN(ofTriangles[i]) ? ofTriangles[i] : none;
      attribute.array.fill(value, 3 * i, 3 * i + 3);
    }
    attribute.needsUpdate = true;
  }

  scale(low, high) {
    this.uniforms.range.value.set(low, high > low ? high : low + 1e-9);
  }

  mark(is_marked) {
    const attribute = this.geometry.getAttribute('mark');
    let any = 0;
    for (let i = 0; i < this.count; ++i) {
      const marked = is_marked && is_marked(i) ? 1 : 0;
      any += marked;
      attribute.array.fill(marked, 3 * i, 3 * i + 3);
    }
    attribute.needsUpdate = true;
    return any;
  }

  fade(opacity, depth = true) {
    this.uniforms.opacity.value = opacity;
    this.material.transparent = opacity < 1;
    this.material.side = depth || opacity >= 1 ? THREE.DoubleSide : THREE.FrontSide;  // half as many layers
    this.material.depthWrite = depth && opacity >= 1;
    this.material.needsUpdate = true;
  }
}

// Corners of elements, from points and the indices of so many to an element, by the corners of their triangles.
export function corners(points, indices, per_element, triangles, elements) {
  const out = new Float32Array(elements.length * triangles.length * 9);
  let at = 0;
  for (const e of elements)
    for (const triangle of triangles)
      for (const c of triangle) {
        const p = 3 * indices[per_element * e + c];
        out[at++] = points[p]; out[at++] = points[p + 1]; out[at++] = points[p + 2];
      }
  return out;
}

export const ofTriangle = [[0, 1, 2]];
export const ofTetrahedron = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
export const all = (n) => Array.from({ length: n }, (_, i) => i);
