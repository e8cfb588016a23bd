// Numbers, units and names in words.

/** A number to so many decimals, without trailing zeros and without "-0". */
export function fixed(value, decimals = 3) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  const text = value.toFixed(decimals);
  const short = text.includes('.') ? text.replace(/\.?0+$/, '') : text;
  return (short === '-0' ? '0' : short).replace('-', '−');
}

/** A number to so many significant digits, written out. */
export function digits(value, count = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  const decimals = Math.max(0, count - 1 - Math.floor(Math.log10(Math.abs(value))));
  return fixed(value, Math.min(decimals, 12));
}

export const count = (number, one, many = `${one}s`) => `${number} ${number === 1 ? one : many}`;

export const percent = (share, decimals = 1) => `${fixed(100 * share, decimals)} %`;

/** "take-off speed" for takeoff_speed_m_s, with its unit. */
export function keyInWords(key) {
  const [name, unit] = splitUnit(key);
  const words = name.replaceAll('_', ' ').replaceAll('takeoff', 'take-off').replaceAll('delta v', 'delta-v');
  return { words, unit };
}

const UNITS = [
  ['_j_kg', 'J/kg'],
  ['_m_s2', 'm/s²'],
  ['_m_s', 'm/s'],
  ['_kg', 'kg'],
  ['_deg', '°'],
  ['_sigma', 'σ'],
  ['_j', 'J'],
  ['_m', 'm'],
  ['_s', 's'],
];

function splitUnit(key) {
  const found = UNITS.find(([ending]) => key.endsWith(ending));
  return found ? [key.slice(0, -found[0].length), found[1]] : [key, ''];
}

const LIMITS = {
  'takeoff-speed': 'greatest take-off speed',
  'landing-speed': 'greatest landing speed',
  'takeoff-cone': 'friction at take-off',
  'landing-cone': 'friction at landing',
  'line-of-sight': 'line of sight',
  'mechanical-angle': 'take-off angles of the mechanism',
  'apex-height': 'greatest apex height',
  'flight-time': 'longest flight',
  'rest-slope': 'slope that a robot rests on',
  'keep-out': 'keep-out zone',
  'keep-in': 'outside the keep-in zones',
  terrain: 'terrain and clearance',
  roughness: 'roughness under the footprint',
  spin: 'spin of the trunk',
};

/** The name of a limit in words. */
export const limitInWords = (limit) => LIMITS[limit] ?? limit.replaceAll('-', ' ');

/** The pair of limits that bound a window: "lower/upper". */
export function bindingInWords(binding) {
  const [lower, upper] = String(binding ?? '').split('/');
  if (!upper) return lower ? limitInWords(lower) : '–';
  return lower === upper ? limitInWords(lower) : `${limitInWords(lower)}; ${limitInWords(upper)}`;
}

/** Which limit a margin is of, and which side of it. */
export function marginInWords(key) {
  const { words, unit } = keyInWords(key);
  const side = words
    .replace(/ cone min$/, ' friction cone, lower side')
    .replace(/ cone max$/, ' friction cone, upper side')
    .replace(/^mechanical angle min$/, 'least angle of the mechanism')
    .replace(/^mechanical angle max$/, 'greatest angle of the mechanism')
    .replace(/^terrain$/, 'height over ground and clearance')
    .replace(/^line of sight$/, 'angle over the line of sight');
  return { words: side, unit };
}

const OUTCOMES = {
  reached: 'reached the goal',
  missed: 'missed the goal',
  slid_at_takeoff: 'slid at take-off',
  slid_at_landing: 'slid at landing',
  damaged: 'landed too fast',
  lost: 'left the map',
  stuck: 'found no further hop',
  hop_limit: 'took too many hops',
  out_of_propellant: 'ran out of propellant',
};

export const outcomeInWords = (name) => OUTCOMES[name] ?? name.replaceAll('_', ' ').replaceAll('-', ' ');
