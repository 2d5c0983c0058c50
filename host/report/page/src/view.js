// The view of mesh and cloud. It is drawn when something changed, not in a loop.
import {
  BufferAttribute, BufferGeometry, DoubleSide, GLSL3, Mesh, OrthographicCamera, Points,
  RawShaderMaterial, Scene, Vector3, Vector4, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import * as shaders from './shaders.js';

const FLIGHT_MS = 450;
const FITTED = 20000; // points and corners that are asked for whether they are in view
const NO_TRIANGLE = -1;
const NO_DEVIATION = 1e30; // shaders.js; not a number has no sure comparison there
const EVERYWHERE = new Vector4(0, 0, 0, 1); // a section that leaves all
const DIRECTIONS = { // where the camera stands, for z up
  front: [0, -1, 0], back: [0, 1, 0], left: [-1, 0, 0], right: [1, 0, 0],
  top: [0, 0, 1], bottom: [0, 0, -1], isometric: [1, -1, 0.8],
};

/** The box of the geometry, relative to its origin. */
function box_of({ points, corners }, step) {
  const low = new Vector3(Infinity, Infinity, Infinity);
  const high = new Vector3(-Infinity, -Infinity, -Infinity);
  const place = new Vector3();
  const grow = (x, y, z) => { place.set(x, y, z); low.min(place); high.max(place); };
  for (let i = 0; i < corners.length; i += 3) grow(corners[i], corners[i + 1], corners[i + 2]);
  for (let i = 0; i < points.length; i += 4) {
    grow(points[i] * step[0], points[i + 1] * step[1], points[i + 2] * step[2]);
  }
  return low.x <= high.x ? { low, high } : { low: new Vector3(), high: new Vector3(1, 1, 1) };
}

export class View {
  /** Draws into a canvas in `stage`. Throws where there is no WebGL. */
  constructor(stage, data, geometry, scale) {
    const canvas = document.createElement('canvas');
    const context = canvas.getContext('webgl2', { antialias: true, alpha: true });
    if (!context) throw new Error('no WebGL');
    this.stage = stage;
    this.canvas = canvas;
    this.scale = scale;
    this.shape = data.geometry;
    this.geometry = geometry;
    this.step = new Vector3(...this.shape.step);
    this.renderer = new WebGLRenderer({ canvas, context, alpha: true });
    this.renderer.setClearColor(0, 0);
    this.box = box_of(geometry, this.shape.step);
    this.centre = this.box.low.clone().add(this.box.high).multiplyScalar(0.5);
    this.radius = this.box.high.distanceTo(this.box.low) / 2 || 1;
    this.section = { value: EVERYWHERE };
    this.on_drawn = () => {};
    this.#make_scene(data, geometry);
    this.#make_camera();
    stage.append(canvas);
    new ResizeObserver(() => this.resize()).observe(stage);
  }

  #material(name, uniforms, more = {}) {
    return new RawShaderMaterial({
      glslVersion: GLSL3, side: DoubleSide, vertexShader: shaders[`${name}_vertex`],
      fragmentShader: shaders[`${name}_fragment`], uniforms: { section: this.section, ...uniforms }, ...more });
  }

  #add(Kind, attributes, material, order = 0) {
    const geometry = new BufferGeometry();
    for (const [name, attribute] of Object.entries(attributes)) geometry.setAttribute(name, attribute);
    const object = new Kind(geometry, material);
    object.frustumCulled = false;
    object.renderOrder = order;
    this.scene.add(object);
    return object;
  }

  #make_scene(data, geometry) {
    const { scale, shape } = this;
    this.scene = new Scene();
    this.go_no_go = { value: false };
    const colours = (slack) => ({
      ramp: { value: scale.stops.flat() }, above: { value: scale.above }, below: { value: scale.below },
      within: { value: scale.within }, range: { value: scale.range }, epsilon: { value: scale.epsilon ?? 0 },
      slack: { value: slack }, diverging: { value: scale.signed }, goNoGo: this.go_no_go });
    // Points within the error of the surface are drawn before it, on whichever side of it they lie.
    const nearer = { value: Math.min(1.05 * data.e_max, 0.02 * this.radius) + 1e-4 * this.radius };
    const deviations = new Float32Array(3 * geometry.deviations.length);
    geometry.deviations.forEach((d, i) => deviations.fill(Number.isNaN(d) ? NO_DEVIATION : d, 3 * i, 3 * i + 3));
    this.mesh = this.#add(Mesh, {
      position: new BufferAttribute(geometry.corners, 3), deviation: new BufferAttribute(deviations, 1) },
    this.#material('mesh', { ...colours(1e-6 * scale.range), faces: { value: true }, edges: { value: true },
      coloured: { value: false }, plain: { value: [0.66, 0.69, 0.72] }, line: { value: [0.08, 0.1, 0.13] },
      marked: { value: NO_TRIANGLE }, lineWidth: { value: 1 } }));
    // A deviation is stored to half a step.
    this.points = this.#add(Points, { position: new BufferAttribute(geometry.points, 4) },
      this.#material('points', { ...colours(0.5 * shape.deviation_step), start: { value: [0, 0, 0] },
        stride: { value: shape.step }, deviationStep: { value: shape.deviation_step }, nearer, size: { value: 2 } }));
    const relative = (list) => new BufferAttribute(Float32Array.from(
      list.flatMap(({ position }) => position.map((value, i) => value - shape.origin[i]))), 3);
    this.excluded = this.#add(Points, { position: relative(data.excluded ?? []) },
      this.#material('sign', { ring: { value: false }, plain: { value: [0.75, 0, 0.55] }, size: { value: 12 }, nearer }));
    this.marker = this.#add(Points, { position: relative([{ position: shape.origin }]) },
      this.#material('sign', { ring: { value: true }, plain: { value: [0, 0, 0] }, size: { value: 30 }, nearer },
        { depthTest: false }), 1);
    this.marker.visible = false;
  }

  #make_camera() {
    const far = 10 * this.radius;
    this.camera = new OrthographicCamera(-1, 1, 1, -1, 0, 2 * far);
    this.distance = far;
    this.camera.up.fromArray(this.shape.up);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.zoomToCursor = true;
    this.controls.minZoom = 0.1;
    this.controls.maxZoom = 1e5;
    this.controls.addEventListener('change', () => this.draw_soon());
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.stage;
    if (!width || !height || (this.size && this.size[0] === width && this.size[1] === height)) return;
    this.size = [width, height];
    this.renderer.setPixelRatio(Math.min(devicePixelRatio || 1, 2));
    this.renderer.setSize(width, height, false);
    const aspect = width / height;
    this.camera.top = this.radius / Math.min(aspect, 1);
    this.camera.bottom = -this.camera.top;
    this.camera.right = this.camera.top * aspect;
    this.camera.left = -this.camera.right;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  draw_soon() {
    this.pending ??= requestAnimationFrame(() => this.draw());
  }

  draw() {
    if (this.pending) cancelAnimationFrame(this.pending);
    this.pending = undefined;
    const ratio = this.renderer.getPixelRatio();
    const points = this.points.material.uniforms;
    points.size.value = ratio * this.#point_size();
    this.mesh.material.uniforms.lineWidth.value = 0.6 * ratio;
    this.excluded.material.uniforms.size.value = 12 * ratio;
    this.marker.material.uniforms.size.value = 30 * ratio;
    this.renderer.render(this.scene, this.camera);
    this.on_drawn();
  }

  /** Pixels of the page for a unit of length. */
  get pixels() { return (this.stage.clientHeight * this.camera.zoom) / (2 * this.camera.top); }

  // As large as the points are apart, within what can be seen and what hides nothing.
  #point_size() {
    const size = this.box.high.clone().sub(this.box.low);
    const area = 2 * (size.x * size.y + size.y * size.z + size.z * size.x);
    const apart = Math.sqrt(area / Math.max(1, this.shape.points));
    return Math.min(Math.max(0.75 * apart * this.pixels, 1.2), 7);
  }

  /** A camera direction of DIRECTIONS, turned for the up axis of the report. */
  #direction(name) {
    const [x, y, z] = DIRECTIONS[name];
    const up = this.shape.up.findIndex((value) => value !== 0);
    const turned = up === 1 ? [x, z, -y] : up === 0 ? [z, x, y] : [x, y, z];
    return new Vector3(...turned).normalize();
  }

  /** Looks at all from a side: a key of DIRECTIONS. */
  look(name) {
    const direction = this.#direction(name);
    if (Math.abs(direction.dot(this.camera.up)) > 0.999) { // which way is up in the picture then
      direction.addScaledVector(this.#direction('front'), 1e-4).normalize();
    }
    this.#place(this.centre, direction, 1);
    this.camera.zoom = this.#zoom_to_fit();
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.draw_soon();
  }

  #place(target, direction, zoom) {
    this.controls.target.copy(target);
    this.camera.position.copy(target).addScaledVector(direction, this.distance);
    this.camera.zoom = zoom;
    this.camera.lookAt(target);
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
  }

  /** The zoom at which all is in view. */
  #zoom_to_fit() {
    let [wide, tall] = [1e-12, 1e-12];
    const { corners, points } = this.geometry;
    const place = new Vector3();
    const widen = () => {
      place.applyMatrix4(this.camera.matrixWorldInverse);
      wide = Math.max(wide, Math.abs(place.x));
      tall = Math.max(tall, Math.abs(place.y));
    };
    const stride = (length, size) => size * Math.max(1, Math.floor(length / size / FITTED));
    for (let i = 0; i < corners.length; i += stride(corners.length, 3)) {
      place.fromArray(corners, i);
      widen();
    }
    for (let i = 0; i < points.length; i += stride(points.length, 4)) {
      place.set(points[i], points[i + 1], points[i + 2]).multiply(this.step);
      widen();
    }
    return 0.92 * Math.min(this.camera.right / wide, this.camera.top / tall);
  }

  /** Moves to a position of the cloud, seen from outside, and marks it and a triangle. */
  fly_to(position, triangle = NO_TRIANGLE) {
    const goal = new Vector3(...position.map((value, i) => value - this.shape.origin[i]));
    this.mark(goal, triangle);
    const from = this.camera.position.clone().sub(this.controls.target).normalize();
    const to = goal.clone().sub(this.centre);
    if (to.length() < 1e-3 * this.radius) to.copy(from);
    to.normalize().addScaledVector(this.camera.up, 0.25).normalize();
    if (from.dot(to) < -0.999) from.addScaledVector(this.#direction('right'), 0.1).normalize();
    const begin = { target: this.controls.target.clone(), zoom: this.camera.zoom };
    const zoom = Math.max(begin.zoom, 6);
    const at = (t) => {
      const direction = from.clone().lerp(to, t).normalize();
      this.#place(begin.target.clone().lerp(goal, t), direction, begin.zoom * (zoom / begin.zoom) ** t);
      this.controls.update();
      this.draw_soon();
    };
    this.#animate(at);
  }

  #animate(at) {
    const flight = this.flight = {};
    if (matchMedia('(prefers-reduced-motion: reduce)').matches) {
      at(1);
      return;
    }
    const begin = performance.now();
    const frame = (now) => {
      if (this.flight !== flight) return;
      const t = Math.min(1, Math.max(0, now - begin) / FLIGHT_MS);
      at(t * t * (3 - 2 * t));
      if (t < 1) requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  /** Ends a flight: the reader takes the camera. */
  stop() { this.flight = undefined; }

  /** Marks a place relative to the origin. */
  mark(place, triangle) {
    place.toArray(this.marker.geometry.attributes.position.array);
    this.marker.geometry.attributes.position.needsUpdate = true;
    this.marker.visible = true;
    this.mesh.material.uniforms.marked.value = triangle ?? NO_TRIANGLE;
    this.draw_soon();
  }

  /** Turns by angles, as the arrow keys ask for. */
  turn(around_up, upwards) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    offset.applyAxisAngle(this.camera.up, around_up);
    const side = new Vector3().crossVectors(this.camera.up, offset).normalize();
    const raised = offset.clone().applyAxisAngle(side, -upwards);
    if (Math.abs(raised.clone().normalize().dot(this.camera.up)) < 0.9999) offset.copy(raised);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
  }

  zoom_by(factor) {
    this.camera.zoom *= factor;
    this.camera.updateProjectionMatrix();
    this.draw_soon();
  }

  /**
   * Cuts across an axis (0, 1, 2) at a share of the box and leaves the lower side, or the upper; a
   * null axis ends it. Answers the coordinate of the cut.
   */
  cut(axis, share, upper) {
    if (axis === null) {
      this.section.value = EVERYWHERE;
      this.draw_soon();
      return null;
    }
    const [low, high] = [this.box.low.getComponent(axis), this.box.high.getComponent(axis)];
    // A hair beyond the box at the ends, so that nothing of it is cut there.
    const at = low + (high - low) * (1.002 * share - 0.001);
    const plane = new Vector4(0, 0, 0, upper ? -at : at);
    plane.setComponent(axis, upper ? -1 : 1);
    this.section.value = plane;
    this.draw_soon();
    return at + this.shape.origin[axis];
  }

  /** What is drawn and how: { points, faces, edges, excluded, coloured, go_no_go }, true or false. */
  show(what) {
    const uniforms = this.mesh.material.uniforms;
    if ('points' in what) this.points.visible = what.points;
    if ('excluded' in what) this.excluded.visible = what.excluded;
    for (const name of ['faces', 'edges', 'coloured']) {
      if (name in what) uniforms[name].value = what[name];
    }
    this.mesh.visible = uniforms.faces.value || uniforms.edges.value;
    if ('go_no_go' in what) this.go_no_go.value = what.go_no_go;
    this.draw_soon();
  }

  /** The drawn picture as a data URL. */
  picture() {
    this.draw();
    return this.canvas.toDataURL('image/png');
  }
}
