// The ground in three dimensions with every arc: three.js, drawn only when something changes. Without WebGL the page says so and goes on.

import {
  BufferAttribute,
  BufferGeometry,
  CanvasTexture,
  Color,
  DirectionalLight,
  DoubleSide,
  Group,
  HemisphereLight,
  Mesh,
  MeshLambertMaterial,
  PerspectiveCamera,
  Points,
  PointsMaterial,
  Raycaster,
  Scene,
  Sprite,
  SpriteMaterial,
  Vector2,
  Vector3,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { Line2 } from 'three/examples/jsm/lines/Line2.js';
import { LineGeometry } from 'three/examples/jsm/lines/LineGeometry.js';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';

import { drawnToWidth, html } from './dom.js';
import { isMarked } from './ground.js';
import { fixed } from './words.js';

const COLOURS = { hop: '#0072b2', drive: '#111111', selected: '#d55e00', tried: '#a8327a', foot: '#000000' };

export function spaceFigure(section, mission, ground, selection) {
  const canvas = html('canvas', { tabindex: '0', role: 'img', 'aria-label': 'Ground and arcs in three dimensions; arrow keys turn the view, plus and minus zoom' });
  let renderer = null;
  try {
    // Asked first on a canvas of its own: three.js tells the console where there is none.
    if (html('canvas').getContext('webgl2')) renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
  } catch {
    renderer = null;
  }
  if (renderer === null) {
    section.append(html('p', { class: 'note', id: 'no-webgl' }, 'This browser has no WebGL: the ground in three dimensions is left out. All numbers and the other figures are complete.'));
    return;
  }
  const view = new View(renderer, canvas, mission, ground);
  const frame = html('div', { class: 'figure space' }, canvas);
  const times = html('output', {}, '1');
  const controls = html(
    'div',
    { class: 'controls' },
    html('label', {}, 'Vertical exaggeration ', html('input', { type: 'range', id: 'exaggeration', min: '1', max: '6', step: '0.5', value: '1', oninput: (event) => exaggerate(event.target) }), ' ', times),
    html('label', { class: 'no-print' }, html('input', { type: 'checkbox', id: 'see-through', checked: ground.facets !== null, onchange: (event) => view.seeThrough(event.target.checked) }), ' see through the ground'),
    html('span', { class: 'no-print' }, 'from ', [['above', [0, -0.0001, 1]], ['south', [0.25, -1, 0.65]], ['west', [-1, -0.25, 0.65]]].map(([name, direction]) => [html('button', { type: 'button', onclick: () => view.look(direction) }, name), ' '])),
  );
  const tinted = ground.layers.length > 0 ? ' Ground in the colour of a layer, as in the map, refuses contact.' : '';
  section.append(controls, frame, html('p', { class: 'note' }, `Drag to turn, wheel or pinch to zoom, right button or two fingers to move. Click an arc to select its hop.${tinted}`));
  drawnToWidth(frame, (width) => view.resize(width, Math.round(Math.min(560, Math.max(280, 0.62 * width)))));
  selection.listen(() => view.mark(selection));
  view.mark(selection);

  function exaggerate(input) {
    times.textContent = fixed(Number(input.value), 1);
    view.exaggerate(Number(input.value));
  }

  let pressed = null;
  canvas.addEventListener('pointerdown', (event) => (pressed = [event.clientX, event.clientY]));
  canvas.addEventListener('pointerup', (event) => {
    const moved = pressed && Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) > 4;
    const leg = moved ? null : view.legAt(event);
    if (leg !== null) selection.select(leg);
  });
  canvas.addEventListener('keydown', (event) => {
    const turn = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] }[event.key];
    const zoom = { '+': 0.85, '=': 0.85, '-': 1 / 0.85 }[event.key];
    if (!turn && !zoom) return;
    event.preventDefault();
    view.turn(...(turn ?? [0, 0]), zoom ?? 1);
  });
}

class View {
  constructor(renderer, canvas, mission, ground) {
    this.renderer = renderer;
    this.mission = mission;
    this.scene = new Scene();
    this.scene.background = new Color('#eef1f4');
    this.scene.add(new HemisphereLight('#ffffff', '#8a8378', 1.1));
    const sun = new DirectionalLight('#ffffff', 2.2);
    sun.position.set(-1, 1, 1.2);
    this.scene.add(sun);
    // Coordinates are taken from the middle of the path: single precision holds no map coordinates.
    const points = mission.legs.flatMap((leg) => leg.plannedInSpace(8) ?? []);
    if (points.length === 0) points.push(...withoutPath(mission, ground));
    const bounds = [0, 1, 2].map((axis) => [Math.min(...points.map((p) => p[axis])), Math.max(...points.map((p) => p[axis]))]);
    this.middle = bounds.map(([low, high]) => (low + high) / 2);
    this.size_m = Math.max(...bounds.slice(0, 2).map(([low, high]) => high - low), 1e-3);
    this.world = new Group();
    this.scene.add(this.world);
    this.grounds = [ground.posts && this.#posts(ground), ground.facets && this.#facets(ground.facets)].filter(Boolean);
    this.world.add(...this.grounds);
    this.seeThrough(ground.facets !== null);
    this.lines = mission.legs.map((leg) => this.#leg(leg)).filter(Boolean);
    this.triedLine = this.#line([[0, 0, 0], [0, 0, 0]], COLOURS.tried, 3.5, true);
    this.triedLine.visible = false;
    this.world.add(this.triedLine);
    if (mission.feet.length > 0) this.world.add(this.#feet());
    for (const place of mission.places) this.#sign(place, ground);
    this.camera = new PerspectiveCamera(38, 1.6, this.size_m * 1e-3, this.size_m * 60);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => this.draw());
    this.look([0.35, -1, 0.7]);
  }

  /** From map coordinates to those of the scene. */
  #local(points) {
    return points.flatMap(([x, y, z]) => [x - this.middle[0], y - this.middle[1], z - this.middle[2]]);
  }

  #posts({ posts, layers }) {
    // A quarter of a million posts draw at once on any machine; finer ones make no difference at this size.
    const stride = Math.max(1, Math.ceil(Math.max(posts.rows, posts.columns) / 400));
    const rows = Math.floor((posts.rows - 1) / stride) + 1;
    const columns = Math.floor((posts.columns - 1) / stride) + 1;
    const positions = new Float32Array(3 * rows * columns);
    const colours = new Float32Array(3 * rows * columns);
    const isGap = new Uint8Array(rows * columns);
    const plain = new Color('#c9c2b6');
    const tints = layers.map(({ stripes }) => new Color(`rgb(${stripes.colour})`).lerp(plain, 0.45));
    for (let row = 0; row < rows; row += 1) {
      for (let column = 0; column < columns; column += 1) {
        const [i, at] = [row * columns + column, row * stride * posts.columns + column * stride];
        const z = posts.z_m[at];
        isGap[i] = Number.isNaN(z) ? 1 : 0;
        const place = [posts.west_m + column * stride * posts.dx_m, posts.north_m - row * stride * posts.dy_m, Number.isNaN(z) ? this.middle[2] : z];
        positions.set(this.#local([place]), 3 * i);
        (tints[layers.findIndex((layer) => isMarked(layer, at))] ?? plain).toArray(colours, 3 * i);
      }
    }
    const corners = [];
    for (let row = 0; row + 1 < rows; row += 1) {
      for (let column = 0; column + 1 < columns; column += 1) {
        const [nw, ne, sw, se] = [0, 1, columns, columns + 1].map((by) => row * columns + column + by);
        // Squares are divided as the program divides them: from the north-west to the south-east post.
        for (const facet of [[nw, se, ne], [nw, sw, se]]) if (!facet.some((corner) => isGap[corner])) corners.push(...facet);
      }
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(positions, 3));
    geometry.setAttribute('color', new BufferAttribute(colours, 3));
    geometry.setIndex(corners);
    geometry.computeVertexNormals();
    return new Mesh(geometry, new MeshLambertMaterial({ vertexColors: true, side: DoubleSide }));
  }

  #facets(facets) {
    const positions = new Float32Array(facets.vertices_m.length);
    for (let i = 0; i < positions.length; i += 1) positions[i] = facets.vertices_m[i] + (facets.origin_m[i % 3] - this.middle[i % 3]);
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(positions, 3));
    geometry.setIndex(new BufferAttribute(facets.corners, 1));
    geometry.computeVertexNormals();
    return new Mesh(geometry, new MeshLambertMaterial({ color: '#c9c2b6', flatShading: true, side: DoubleSide }));
  }

  #line(points, colour, width_px, dashed = false) {
    const geometry = new LineGeometry();
    geometry.setPositions(this.#local(points));
    const material = new LineMaterial({ color: colour, linewidth: width_px, dashed, dashSize: this.size_m / 80, gapSize: this.size_m / 160 });
    const line = new Line2(geometry, material);
    if (dashed) line.computeLineDistances();
    return line;
  }

  #leg(leg) {
    const points = leg.plannedInSpace(40);
    if (!points) return null;
    const line = this.#line(points, COLOURS[leg.kind], 2.5);
    line.userData.leg = leg.index;
    this.world.add(line);
    return line;
  }

  #feet() {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(Float32Array.from(this.#local(this.mission.feet)), 3));
    return new Points(geometry, new PointsMaterial({ color: COLOURS.foot, size: 5, sizeAttenuation: false }));
  }

  /** A name that stands over a place and keeps its size on the screen. */
  #sign({ name, x_m, y_m, z_m }, ground) {
    const height_m = z_m ?? heightAt(ground.posts, x_m, y_m) ?? this.middle[2];
    const canvas = html('canvas', { width: 512, height: 64 });
    const context = canvas.getContext('2d');
    context.font = '600 40px system-ui, sans-serif';
    const wide = context.measureText(name).width;
    context.lineWidth = 8;
    context.strokeStyle = '#ffffff';
    context.strokeText(name, 256 - wide / 2, 46);
    context.fillText(name, 256 - wide / 2, 46);
    const sprite = new Sprite(new SpriteMaterial({ map: new CanvasTexture(canvas), sizeAttenuation: false, depthTest: false }));
    sprite.scale.set(0.28, 0.035, 1);
    sprite.center.set(0.5, -0.1);
    sprite.position.set(...this.#local([[x_m, y_m, height_m]]));
    this.world.add(sprite);
  }

  resize(width, height) {
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  /** Looks at the middle of the path from a direction. */
  look(direction) {
    const distance_m = 1.35 * this.size_m;
    this.controls.target.set(0, 0, 0);
    this.camera.position.copy(new Vector3(...direction).normalize().multiplyScalar(distance_m));
    this.controls.update();
    this.draw();
  }

  turn(azimuth, polar, zoom) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    offset.applyAxisAngle(this.camera.up, azimuth);
    const across = new Vector3().crossVectors(this.camera.up, offset).normalize();
    const turned = offset.clone().applyAxisAngle(across, polar);
    // Not over the zenith, where left and right would change places.
    if (turned.angleTo(this.camera.up) > 0.05 && turned.angleTo(this.camera.up) < 3.0) offset.copy(turned);
    this.camera.position.copy(this.controls.target).add(offset.multiplyScalar(zoom));
    this.controls.update();
    this.draw();
  }

  /** Whether arcs are seen behind the ground and inside caves. */
  seeThrough(on) {
    for (const { material } of this.grounds) Object.assign(material, { transparent: on, opacity: on ? 0.35 : 1, depthWrite: !on, needsUpdate: true });
    this.draw();
  }

  exaggerate(times) {
    this.world.scale.z = times;
    this.draw();
  }

  mark(selection) {
    for (const line of this.lines) {
      const selected = line.userData.leg === selection.leg;
      line.material.color.set(selected ? COLOURS.selected : COLOURS[this.mission.legs[line.userData.leg].kind]);
      line.material.linewidth = selected ? 4.5 : 2.5;
    }
    const points = selection.tried && selection.selected.inSpace(selection.tried, 40);
    this.triedLine.visible = Boolean(points);
    if (points) {
      this.triedLine.geometry.dispose();
      this.triedLine.geometry = new LineGeometry();
      this.triedLine.geometry.setPositions(this.#local(points));
      this.triedLine.computeLineDistances();
    }
    this.draw();
  }

  /** The leg whose line is under the pointer; null where there is none. */
  legAt(event) {
    const { left, top, width, height } = this.renderer.domElement.getBoundingClientRect();
    const raycaster = new Raycaster();
    raycaster.params.Line2 = { threshold: 10 };
    raycaster.setFromCamera(new Vector2((2 * (event.clientX - left)) / width - 1, 1 - (2 * (event.clientY - top)) / height), this.camera);
    const hits = raycaster.intersectObjects(this.lines);
    return hits.length > 0 ? hits[0].object.userData.leg : null;
  }

  draw() {
    if (this.camera) this.renderer.render(this.scene, this.camera);
  }
}

/** Points that the view holds where there is no path: the ends, else the ground. */
function withoutPath(mission, ground) {
  const places = mission.places.map(({ x_m, y_m, z_m }) => [x_m, y_m, z_m ?? heightAt(ground.posts, x_m, y_m) ?? 0]);
  if (places.length > 1) return places;
  const { west_m, east_m, south_m, north_m } = ground.posts?.bounds ?? ground.facets.bounds;
  const z_m = ground.posts?.range_m[0] ?? ground.facets.origin_m[2];
  return [[west_m, south_m, z_m], [east_m, north_m, z_m]];
}

function heightAt(posts, x_m, y_m) {
  if (!posts) return null;
  const z_m = posts.at(Math.round((posts.north_m - y_m) / posts.dy_m), Math.round((x_m - posts.west_m) / posts.dx_m));
  return Number.isNaN(z_m) ? null : z_m;
}
