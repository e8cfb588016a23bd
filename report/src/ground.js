// The ground that is embedded in the page: posts of a DEM as 16-bit steps, or facets of a mesh; hillshade and bands of height.

/** The numbers of a base64 text of little-endian values. */
function decoded(text, Type) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return new Type(bytes.buffer);
}

const NO_DATA = 65535;

/** Posts of an elevation raster, row after row from the north-west. */
export class Posts {
  constructor(record) {
    Object.assign(this, record);
    const steps = decoded(record.steps, Uint16Array);
    this.z_m = Float64Array.from(steps, (step) => (step === NO_DATA ? NaN : record.z_min_m + step * record.z_step_m));
  }

  at(row, column) {
    const r = Math.min(this.rows - 1, Math.max(0, row));
    const c = Math.min(this.columns - 1, Math.max(0, column));
    return this.z_m[r * this.columns + c];
  }

  get bounds() {
    const { west_m, north_m, dx_m, dy_m, rows, columns } = this;
    return { west_m, north_m, east_m: west_m + (columns - 1) * dx_m, south_m: north_m - (rows - 1) * dy_m };
  }

  get range_m() {
    let [low, high] = [Infinity, -Infinity];
    for (const z of this.z_m) {
      if (z < low) low = z;
      if (z > high) high = z;
    }
    return [low, high];
  }

  /** Light of the north-west, 45 degrees high, on the ground about a post: 0 to 1; NaN without data. */
  shade(row, column) {
    const east = (this.at(row, column + 1) - this.at(row, column - 1)) / (2 * this.dx_m);
    const north = (this.at(row - 1, column) - this.at(row + 1, column)) / (2 * this.dy_m);
    return (1 + (east - north) / Math.SQRT2) / Math.SQRT2 / Math.sqrt(1 + east * east + north * north);
  }
}

/** Facets of a mesh. */
export class Facets {
  constructor(record) {
    Object.assign(this, record);
    this.vertices_m = decoded(record.vertices, Float32Array);
    this.corners = decoded(record.corners, Uint32Array);
    const [x, y] = record.origin_m;
    let [west, south, east, north] = [Infinity, Infinity, -Infinity, -Infinity];
    for (let i = 0; i < this.vertices_m.length; i += 3) {
      west = Math.min(west, this.vertices_m[i]);
      east = Math.max(east, this.vertices_m[i]);
      south = Math.min(south, this.vertices_m[i + 1]);
      north = Math.max(north, this.vertices_m[i + 1]);
    }
    this.bounds = { west_m: x + west, east_m: x + east, south_m: y + south, north_m: y + north };
  }

  /** Corner `which` of a facet: [x, y, z], m. */
  corner(facet, which) {
    const at = 3 * this.corners[3 * facet + which];
    return [0, 1, 2].map((axis) => this.origin_m[axis] + this.vertices_m[at + axis]);
  }

  /** The facets that face up, lowest first, each with its corners, the light on it, and whether it lies over the path beside it. */
  facingUp(path_m) {
    const found = [];
    for (let facet = 0; facet < this.corners.length / 3; facet += 1) {
      const [a, b, c] = [0, 1, 2].map((which) => this.corner(facet, which));
      const [u, v] = [b, c].map((p) => p.map((value, axis) => value - a[axis]));
      const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
      const length = Math.hypot(...n);
      if (!(n[2] > 1e-6 * length)) continue;
      const light = Math.max(0, (-n[0] + n[1] + Math.SQRT2 * n[2]) / (2 * length));
      const middle = [0, 1, 2].map((axis) => (a[axis] + b[axis] + c[axis]) / 3);
      const away = ([x_m, y_m]) => (x_m - middle[0]) ** 2 + (y_m - middle[1]) ** 2;
      const beside = path_m.length > 0 ? path_m.reduce((best, at) => (away(at) < away(best) ? at : best)) : null;
      found.push({ corners: [a, b, c], light, z_m: middle[2], isOver: beside !== null && middle[2] > beside[2] });
    }
    return found.sort((a, b) => a.z_m - b.z_m);
  }
}

export function groundOf(mission) {
  const { posts, facets, layers } = mission.ground;
  return {
    posts: posts ? new Posts(posts) : null,
    facets: facets ? new Facets(facets) : null,
    layers: marked(layers ?? [], posts),
  };
}

// Each layer has stripes of its own colour and direction: apart from the hillshade and from one another for colour-blind readers and in grey.
const STRIPES = [
  { colour: [213, 94, 0], turn_deg: 135, covers: (row, column) => (row + column) % 4 < 2 },
  { colour: [0, 114, 178], turn_deg: 45, covers: (row, column) => (row + 3 * column) % 4 < 2 },
  { colour: [204, 121, 167], turn_deg: 0, covers: (row) => row % 4 < 2 },
  { colour: [0, 158, 115], turn_deg: 90, covers: (row, column) => column % 4 < 2 },
];

/** The layers that refuse contact at any post, with their share of all posts and their stripes. */
function marked(layers, posts) {
  const all = posts ? posts.rows * posts.columns : 0;
  const masked = layers.map((layer) => ({ ...layer, mask: decoded(layer.bits, Uint8Array) }));
  for (const layer of masked) layer.share = Array.from({ length: all }).reduce((sum, _, at) => sum + isMarked(layer, at), 0) / Math.max(1, all);
  return masked.filter(({ share }) => share > 0).map((layer, number) => ({ ...layer, stripes: STRIPES[number % STRIPES.length] }));
}

/** Whether a post is marked in a layer. */
export const isMarked = (layer, index) => ((layer.mask[index >> 3] >> (index & 7)) & 1) === 1;

// Cividis in seven steps: it keeps its order in grey and for colour-blind readers.
const BANDS = [
  [0, 32, 77],
  [44, 62, 107],
  [85, 91, 108],
  [121, 120, 117],
  [161, 150, 113],
  [205, 183, 94],
  [253, 231, 55],
];

/** Up to seven bands of round heights. */
export function heightBands(low, high) {
  const rough = (high - low) / 7;
  const power = 10 ** Math.floor(Math.log10(rough));
  for (const factor of [1, 2, 5, 10, 20]) {
    const step = factor * power;
    const first = Math.floor(low / step);
    const number = Math.ceil(high / step) - first;
    if (number <= 7) {
      const colour = (i) => BANDS[number === 1 ? 3 : Math.round((i * (BANDS.length - 1)) / (number - 1))];
      return Array.from({ length: number }, (_, i) => ({ from_m: (first + i) * step, to_m: (first + i + 1) * step, colour: colour(i) }));
    }
  }
  return [];
}
