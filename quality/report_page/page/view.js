// The interactive view: scene, camera, cut, selection. Draws when something has changed, and not otherwise.
import * as THREE from 'three';
import { OrbitControls } from 'orbit-controls';
import { section } from './cut.js';
import { Surface, all, corners, ofTetrahedron, ofTriangle } from './surface.js';

const chosenColour = [0, 163, 122];
const faded = 0.16;
const mostWithEdges = 40000;  // beyond, all would be edges
const mostMarked = 60000;  // tetrahedra that are drawn whole

const directions = { all: [1, -1.4, 0.9], front: [0, -1, 0], right: [1, 0, 0], top: [0, -0.0001, 1] };

// Without a graphics card smooth silhouettes make a frame take twice as long.
function contextOf(canvas) {
  return canvas.getContext('webgl2', { antialias: true, alpha: true, failIfMajorPerformanceCaveat: true })
    || canvas.getContext('webgl2', { antialias: false, alpha: true });
}

export class View {
  constructor(canvas, description, data, frame) {
    this.canvas = canvas;
    this.data = data;
    this.frame = frame;
    this.part = 'result';
    this.blend = 0.5;
    this.cut = { on: false, axis: 0, place: 0.5, flip: false };
    this.colouring = null;
    this.isVolume = description.result.is_volume;
    const context = contextOf(canvas);
    if (!context) throw new Error('WebGL 2 is needed');
    this.renderer = new THREE.WebGLRenderer({ canvas, context, alpha: true });
    this.renderer.setClearColor(0x000000, 0);
    this.renderer.autoClear = false;
    this.build(description);
    this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -4, 8);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableKeys = false;
    this.controls.screenSpacePanning = true;
    this.controls.addEventListener('change', () => this.draw());
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
    this.look('all');
  }

  build(description) {
    const { data, frame } = this, neutral = description.neutral, options = { neutral, chosen: chosenColour };
    this.options = options;
    this.points = frame.points(data['result.positions']);
    this.triangles = data['result.triangles'];
    this.tetrahedra = data['result.tetrahedra'] || null;
    const count = this.triangles.length / 3;
    this.result = new Surface(corners(this.points, this.triangles, 3, ofTriangle, all(count)), options);
    this.scene = new THREE.Scene();
    this.scene.add(this.result.mesh);
    this.reference = null;
    if (data['reference.triangles']) {
      const points = frame.points(data['reference.positions']), triangles = data['reference.triangles'];
      this.reference = new Surface(corners(points, triangles, 3, ofTriangle, all(triangles.length / 3)), options);
      this.reference.material.polygonOffset = true;
      this.reference.material.polygonOffsetFactor = this.reference.material.polygonOffsetUnits = -2;
      this.reference.uniforms.edges.value = 0;
      this.scene.add(this.reference.mesh);
    }
    this.cap = null;
    this.chosen = null;
    this.withEdges = count <= mostWithEdges;
    this.result.uniforms.edges.value = this.withEdges ? 1 : 0;
    this.pin = new THREE.Mesh(new THREE.SphereGeometry(0.006, 16, 12), new THREE.MeshBasicMaterial({ color: 0x00a37a, depthTest: false, transparent: true }));
    this.pin.visible = false;
    this.pin.renderOrder = 10;
    this.scene.add(this.pin);
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    const ratio = Math.min(2, window.devicePixelRatio || 1), size = [clientWidth, clientHeight, ratio].join();
    if (!clientWidth || !clientHeight || size === this.size) return;
    this.size = size;
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.draw();
  }

  // Of the whole, which has the size 1, or so much of it.
  look(name) {
    this.watch([0, 0, 0], directions[name], this.extent(directions[name]));
  }

  // How high a picture has to be, so that all of the mesh is in it from this direction.
  extent(direction) {
    const camera = new THREE.Matrix4().lookAt(new THREE.Vector3(...direction), new THREE.Vector3(), this.camera.up), m = camera.elements;
    const { clientWidth, clientHeight } = this.canvas.parentElement, aspect = Math.max(1, clientWidth / (clientHeight || 1));
    let largest = 0;
    for (let i = 0; i < this.points.length; i += 3)
      for (let row = 0; row < 2; ++row) {
        const x = Math.abs(m[4 * row] * this.points[i] + m[4 * row + 1] * this.points[i + 1] + m[4 * row + 2] * this.points[i + 2]);
        largest = Math.max(largest, row === 0 ? x / aspect : x);
      }
    return 2.1 * largest || 1;
  }

  watch(place, direction, height) {
    const target = new THREE.Vector3(...place), away = new THREE.Vector3(...direction).normalize();
    this.controls.target.copy(target);
    this.camera.position.copy(target).addScaledVector(away, 2);
    this.camera.zoom = 1 / height;
    this.controls.update();
    this.draw();
  }

  // By degrees, around the vertical and the horizontal axis.
  turn(around, over) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const spherical = new THREE.Spherical().setFromVector3(new THREE.Vector3(offset.x, offset.z, -offset.y));
    spherical.theta += (around * Math.PI) / 180;
    spherical.phi = Math.min(Math.PI - 0.001, Math.max(0.001, spherical.phi + (over * Math.PI) / 180));
    const v = new THREE.Vector3().setFromSpherical(spherical);
    this.camera.position.copy(this.controls.target).add(new THREE.Vector3(v.x, -v.z, v.y));
    this.controls.update();
    this.draw();
  }

  move(right, up) {
    const step = 0.06 / this.camera.zoom, m = this.camera.matrix.elements;
    const by = new THREE.Vector3(m[0] * right + m[4] * up, m[1] * right + m[5] * up, m[2] * right + m[6] * up).multiplyScalar(step);
    this.camera.position.add(by);
    this.controls.target.add(by);
    this.controls.update();
    this.draw();
  }

  zoom(factor) {
    this.camera.zoom *= factor;
    this.controls.update();
    this.draw();
  }

  colour(colouring, low, high) {
    this.colouring = colouring;
    this.result.colour(colouring.table, low, high, colouring.ofFaces());
    if (this.reference) this.reference.colour(colouring.table, low, high, colouring.ofReference());
    this.updateCap(low, high);
    this.range = [low, high];
    this.draw();
  }

  scale(low, high) {
    this.range = [low, high];
    for (const surface of [this.result, this.reference, this.cap]) if (surface) surface.scale(low, high);
    this.draw();
  }

  edges(on) {
    this.withEdges = on;
    this.result.uniforms.edges.value = on ? 1 : 0;
    this.updateCap(...this.range);
    this.draw();
  }

  // Place from 0 to 1 along the axis of the box.
  plane() {
    if (!this.cut.on) return [0, 0, 0, 1];
    const { axis, place, flip } = this.cut, { low, high, toScene } = this.frame;
    const at = toScene(low.map((l, k) => l + place * (high[k] - l)))[axis], sign = flip ? -1 : 1;
    return [0, 1, 2].map((k) => (k === axis ? sign : 0)).concat(sign * at);
  }

  setCut(cut) {
    Object.assign(this.cut, cut);
    for (const surface of [this.result, this.reference]) if (surface) surface.uniforms.cut.value.set(...this.plane());
    this.updateCap(...this.range);
    this.draw();
  }

  updateCap(low, high) {
    if (this.cap) {
      this.scene.remove(this.cap.mesh, this.lines);
      this.cap.geometry.dispose();
      this.lines.geometry.dispose();
      this.cap = null;
    }
    this.cutTetrahedra = 0;
    if (!this.cut.on || !this.tetrahedra) return;
    const cut = section(this.points, this.tetrahedra, this.plane());
    this.cutTetrahedra = new Set(cut.owner).size;
    this.cap = new Surface(cut.corners, { ...this.options, lit: 0 });
    this.cap.owner = cut.owner;
    this.cap.uniforms.edges.value = 0;
    const values = this.colouring.ofTetrahedra();
    this.cap.colour(this.colouring.table, low, high, values ? cut.owner.map((e) => values[e]) : null);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(cut.sides, 3));
    geometry.boundingSphere = new THREE.Sphere(new THREE.Vector3(), 1);
    this.lines = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: 0x3a414a }));
    this.lines.visible = this.withEdges;
    this.scene.add(this.cap.mesh, this.lines);
  }

  clearChoice() {
    if (this.chosen) {
      this.scene.remove(this.chosen.mesh);
      this.chosen.geometry.dispose();
      this.chosen = null;
    }
    this.result.mark(null);
    this.result.uniforms.dimmed.value = 0;
    this.result.fade(1);
    this.pin.visible = false;
    this.draw();
  }

  // Triangles by their place in the view.
  chooseTriangles(is_chosen) {
    this.clearChoice();
    const count = this.result.mark(is_chosen);
    this.result.uniforms.dimmed.value = 0.85;
    this.draw();
    return count;
  }

  chooseTetrahedra(elements) {
    this.clearChoice();
    const shown = elements.slice(0, mostMarked);
    this.solid(corners(this.points, this.tetrahedra, 4, ofTetrahedron, shown));
    return shown.length;
  }

  // One element, by its corners in the model, and the camera at it.
  chooseElement(ofElement) {
    this.clearChoice();
    const points = new Float32Array(ofElement.flatMap((p) => this.frame.toScene(p)));
    const n = ofElement.length;
    this.solid(corners(points, all(n), n, n === 4 ? ofTetrahedron : ofTriangle, [0]));
    const middle = [0, 1, 2].map((k) => points.filter((_, i) => i % 3 === k).reduce((a, b) => a + b) / n);
    const size = Math.max(...all(n).map((i) => Math.hypot(...[0, 1, 2].map((k) => points[3 * i + k] - middle[k]))));
    this.watch(middle, this.freeDirection(middle, 4 * size), Math.max(24 * size, 1e-4));
  }

  showPlace(place) {
    this.clearChoice();
    const at = this.frame.toScene(place);
    this.pin.position.set(...at);
    this.pin.scale.setScalar(0.35);
    this.pin.visible = true;
    this.watch(at, this.freeDirection(at, 0.004), 0.35);
  }

  direction() {
    return this.camera.position.clone().sub(this.controls.target).toArray();
  }

  // From where nothing hides the place, but for what is nearer to it than `near`: the direction that the view has, or
  // the one that looks at the surface most straightly.
  freeDirection(at, near) {
    const normal = new THREE.Vector3(...(this.nearestNormal(at) || this.direction())).normalize();
    const around = [];
    for (const x of [-1, 0, 1]) for (const y of [-1, 0, 1]) for (const z of [-1, 0, 1]) if (x || y || z) around.push(new THREE.Vector3(x, y, z + 1e-3).normalize());
    around.sort((a, b) => b.dot(normal) - a.dot(normal));
    const own = new THREE.Vector3(...this.direction()).normalize();
    const candidates = (own.dot(normal) > 0.4 ? [own] : []).concat(normal, around.slice(0, 14));
    return (candidates.find((d) => !this.isHidden(at, d, near)) || normal).toArray();
  }

  isHidden(at, direction, near) {
    const ray = new THREE.Ray(new THREE.Vector3(...at), direction), c = this.result.corners;
    const [a, b, d, hit] = [0, 0, 0, 0].map(() => new THREE.Vector3());
    for (let i = 0; i < this.result.count; ++i) {
      a.fromArray(c, 9 * i); b.fromArray(c, 9 * i + 3); d.fromArray(c, 9 * i + 6);
      if (ray.intersectTriangle(a, b, d, false, hit) && hit.distanceTo(ray.origin) > near) return true;
    }
    return false;
  }

  // Of the triangle whose middle is nearest, a little from the side, so that its relief is seen.
  nearestNormal(at) {
    let best = Infinity, nearest = -1;
    const c = this.result.corners;
    for (let i = 0; i < this.result.count; ++i) {
      let d = 0;
      for (let k = 0; k < 3; ++k) d += ((c[9 * i + k] + c[9 * i + 3 + k] + c[9 * i + 6 + k]) / 3 - at[k]) ** 2;
      if (d < best) { best = d; nearest = i; }
    }
    if (nearest < 0) return null;
    const corner = (j) => new THREE.Vector3(c[9 * nearest + 3 * j], c[9 * nearest + 3 * j + 1], c[9 * nearest + 3 * j + 2]);
    const [a, b, d] = [corner(0), corner(1), corner(2)];
    const normal = b.sub(a).cross(d.sub(a)).normalize();
    return normal.add(new THREE.Vector3(0.15, -0.1, 0.25)).toArray();
  }

  solid(cornersOfTriangles) {
    this.chosen = new Surface(cornersOfTriangles, { ...this.options, neutral: chosenColour, lit: 0.5 });
    this.chosen.mark(() => true);
    this.result.fade(faded, false);
    this.chosen.mesh.renderOrder = -1;
    this.scene.add(this.chosen.mesh);
    this.draw();
  }

  show(part, blend) {
    this.part = part;
    this.blend = blend;
    if (this.reference) this.reference.fade(part === 'blend' ? blend : 1);
    this.draw();
  }

  draw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.render();
    });
  }

  render() {
    const { renderer, camera, canvas } = this;
    const width = canvas.clientWidth, height = canvas.clientHeight, both = this.part === 'both';
    const half = both ? Math.floor(width / 2) : width, aspect = half / height;
    // The whole fits whichever side is the shorter.
    const tall = aspect >= 1 ? 1 : 1 / aspect;
    Object.assign(camera, { left: -0.5 * tall * aspect, right: 0.5 * tall * aspect, top: 0.5 * tall, bottom: -0.5 * tall });
    camera.updateProjectionMatrix();
    renderer.setScissorTest(true);
    const pane = (x, wide, result, reference) => {
      renderer.setViewport(x, 0, wide, height);
      renderer.setScissor(x, 0, wide, height);
      renderer.clear();
      for (const object of [this.result.mesh, this.cap && this.cap.mesh, this.cap && this.lines, this.chosen && this.chosen.mesh])
        if (object) object.visible = result;
      if (this.cap && result) this.lines.visible = this.withEdges;
      if (this.reference) this.reference.mesh.visible = reference;
      renderer.render(this.scene, camera);
    };
    if (both) {
      pane(0, half, false, true);
      pane(half, width - half, true, false);
    } else {
      pane(0, width, this.part !== 'reference', this.part === 'reference' || this.part === 'blend');
    }
    canvas.dataset.direction = this.direction().map((x) => x.toFixed(4)).join(' ');
    canvas.dataset.zoom = camera.zoom.toFixed(4);
    canvas.dataset.cutTetrahedra = this.cutTetrahedra || 0;
    canvas.dataset.drawn = +(canvas.dataset.drawn || 0) + 1;
  }

  // What is seen at a place of the canvas: {triangle} or {tetrahedron}, or nothing.
  pick(x, y) {
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    let wide = width;
    if (this.part === 'both') {
      wide = Math.floor(width / 2);
      if (x < wide) return null;
      x -= wide;
    } else if (this.part === 'reference') {
      return null;
    }
    const ray = new THREE.Raycaster();
    ray.setFromCamera({ x: (2 * x) / wide - 1, y: 1 - (2 * y) / height }, this.camera);
    const { origin, direction } = ray.ray, plane = this.plane();
    const nearest = (c, count) => {
      let best = Infinity, found = -1;
      const a = new THREE.Vector3(), b = new THREE.Vector3(), d = new THREE.Vector3(), hit = new THREE.Vector3();
      for (let i = 0; i < count; ++i) {
        a.fromArray(c, 9 * i); b.fromArray(c, 9 * i + 3); d.fromArray(c, 9 * i + 6);
        if (!ray.ray.intersectTriangle(a, b, d, false, hit)) continue;
        if (plane[0] * hit.x + plane[1] * hit.y + plane[2] * hit.z > plane[3] + 1e-6) continue;
        const far = hit.sub(origin).dot(direction);
        if (far < best) { best = far; found = i; }
      }
      return { best, found };
    };
    const surface = nearest(this.result.corners, this.result.count);
    const cap = this.cap ? nearest(this.cap.corners, this.cap.count) : { best: Infinity, found: -1 };
    if (cap.found >= 0 && cap.best <= surface.best + 1e-6) return { tetrahedron: this.cap.owner[cap.found] };
    return surface.found >= 0 ? { triangle: surface.found } : null;
  }
}
