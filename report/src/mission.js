// The answer documents as one mission: its legs in order, its ground, its trials. Every number comes from the documents.

import { Arc, slopeOf } from './arcs.js';

/** The documents and the ground that are embedded in the page. */
export function embedded() {
  const answers = [...document.querySelectorAll('script.answer')].map((node) => ({
    name: node.dataset.name,
    value: JSON.parse(node.textContent),
    // The text as chta wrote it: `<` stands in it as an escape, so that no text can end the element.
    text: node.textContent.trim().replace(/(?<!\\)((?:\\\\)*)\\u003c/g, '$1<') + '\n',
  }));
  return { answers, ground: JSON.parse(document.getElementById('ground').textContent) };
}

const kindOf = (answer) => answer.value.schema.split('/')[1];

/** One hop or one drive. */
class Leg {
  constructor(index, record, start, end, gravity_m_s2) {
    this.index = index;
    this.record = record;
    this.kind = record.kind ?? 'hop';
    /** {along_m, z_m} and, on a map, {x_m, y_m}. */
    this.start = start;
    this.end = end;
    if (this.kind !== 'hop') return;
    this.gravity_m_s2 = gravity_m_s2;
    this.window_deg = [record.takeoff_angle_min_deg, record.takeoff_angle_max_deg];
    this.rise_m = end.z_m - start.z_m;
    const runs = [Math.abs(end.along_m - start.along_m)];
    if (start.x_m !== undefined) runs.push(Math.hypot(end.x_m - start.x_m, end.y_m - start.y_m));
    // A hop beside the line of its profile is longer than the profile between its ends: the run that agrees with the stated speed counts.
    const off = (run_m) => Math.abs(this.#arc(run_m, record.takeoff_angle_deg).takeoff_speed_m_s - record.takeoff_speed_m_s);
    this.run_m = runs.reduce((best, run_m) => (off(run_m) < off(best) ? run_m : best));
    /** By how much the drawn arc's speed differs from the stated one, as a share of it. */
    this.speed_error = off(this.run_m) / record.takeoff_speed_m_s;
  }

  #arc(run_m, angle_deg) {
    return new Arc(run_m, this.rise_m, slopeOf(angle_deg), this.gravity_m_s2);
  }

  /** The arc with this take-off angle between the same contacts. */
  arcAt(angle_deg) {
    return this.#arc(this.run_m, angle_deg);
  }

  get arc() {
    return this.kind === 'hop' ? this.arcAt(this.record.takeoff_angle_deg) : null;
  }

  get name() {
    return this.kind === 'hop' ? `Hop ${this.record.hop}` : `Drive (leg ${this.record.leg})`;
  }

  /** Points of an arc of this hop, along the profile: [along, z]. */
  alongProfile(arc, count) {
    const sign = Math.sign(this.end.along_m - this.start.along_m) || 1;
    const scale = Math.abs(this.end.along_m - this.start.along_m) / this.run_m;
    return arc.points(count).map(([d, h]) => [this.start.along_m + sign * scale * d, this.start.z_m + h]);
  }

  /** The same in space: [x, y, z]; null where there is no map. */
  inSpace(arc, count) {
    if (this.start.x_m === undefined) return null;
    const share = (d) => d / this.run_m;
    return arc
      .points(count)
      .map(([d, h]) => [
        this.start.x_m + (this.end.x_m - this.start.x_m) * share(d),
        this.start.y_m + (this.end.y_m - this.start.y_m) * share(d),
        this.start.z_m + h,
      ]);
  }

  /** The leg as it is planned, in space. */
  plannedInSpace(count) {
    return this.kind === 'hop' ? this.inSpace(this.arc, count) : this.record.waypoints_m;
  }
}

function legsOf(path, gravity_m_s2) {
  let along_m = 0;
  return path.map((record, index) => {
    if (record.kind === 'drive') {
      const [first, last] = [record.waypoints_m[0], record.waypoints_m[record.waypoints_m.length - 1]];
      const place = ([x_m, y_m, z_m], at_m) => ({ along_m: at_m, x_m, y_m, z_m });
      const leg = new Leg(index, record, place(first, along_m), place(last, along_m + record.distance_m), gravity_m_s2);
      along_m = leg.end.along_m;
      return leg;
    }
    const end = (which) => ({
      along_m: record[`${which}_x_m`],
      z_m: record[`${which}_z_m`],
      ...(record[`${which}_map_x_m`] !== undefined && { x_m: record[`${which}_map_x_m`], y_m: record[`${which}_map_y_m`] }),
    });
    const leg = new Leg(index, record, end('takeoff'), end('landing'), gravity_m_s2);
    along_m = leg.end.along_m;
    return leg;
  });
}

/** Trials in one shape, of every kind of document that has them. */
function trialsOf(value) {
  const source = value.simulation ?? value;
  if (source.trials === undefined || source.success_rate === undefined) return null;
  const outcomes = Array.isArray(source.outcomes)
    ? source.outcomes.map(({ outcome, trials }) => [outcome, trials])
    : Object.entries(source.outcomes ?? {});
  return { ...source, ci95: source.success_rate_ci95 ?? source.success_ci95, outcomes };
}

export class Mission {
  constructor({ answers, ground }) {
    this.answers = answers;
    this.ground = ground;
    const withPath = answers.filter((answer) => answer.value.path !== undefined);
    const isTrials = (answer) => kindOf(answer).startsWith('simulate');
    this.plan = withPath.find((answer) => !isTrials(answer)) ?? withPath[0];
    this.kind = kindOf(this.plan);
    const plan = this.plan.value;
    this.value = plan;
    this.scenario = plan.scenario;
    this.gravity_m_s2 = plan.scenario.body.gravity_m_s2;
    this.legs = legsOf(plan.path ?? [], this.gravity_m_s2);
    this.title = plan.scenario.report?.title ?? 'Hopping traversability';
    this.trials = answers.map((answer) => trialsOf(answer.value)).find((trials) => trials && trials.errors === undefined) ?? null;
    this.sensitivity = answers.find((answer) => Array.isArray(answer.value.errors))?.value ?? null;
    this.trade = answers.find((answer) => kindOf(answer) === 'trade')?.value ?? null;
  }

  get hops() {
    return this.legs.filter((leg) => leg.kind === 'hop');
  }

  get isOnMap() {
    return this.ground.posts !== undefined || this.ground.facets !== undefined || this.legs.some((leg) => leg.start.x_m !== undefined);
  }

  /** Nodes of the planner, in its own word. */
  get nodesWord() {
    return this.value.roadmap ? 'contacts' : 'nodes';
  }

  /** Named places on the map: start, goal, targets; and contacts of feet. */
  get places() {
    const places = [];
    const add = (name, at, z_m) => at && places.push({ name, x_m: at[0], y_m: at[1], z_m });
    const { value, legs } = this;
    const [first, last] = [legs[0], legs[legs.length - 1]];
    const terrain = this.scenario.terrain ?? {};
    const given = (end) => value[`${end}_m`] ?? value[end]?.point_m ?? (Array.isArray(terrain[`${end}_m`]) ? terrain[`${end}_m`] : null);
    const start = given('start');
    if (first?.start.x_m !== undefined) add('start', [first.start.x_m, first.start.y_m], first.start.z_m);
    else if (start) add('start', start, start[2]);
    if (value.targets) {
      for (const { target, at_m, visit } of value.targets) add(`target ${target}${visit ? '' : ' (left out)'}`, at_m, at_m[2]);
    } else {
      const goal = given('goal');
      if (last?.end.x_m !== undefined) add('goal', [last.end.x_m, last.end.y_m], last.end.z_m);
      else if (goal) add('goal', goal, goal[2]);
    }
    return places;
  }

  /** Where the feet of a robot with legs stand. */
  get feet() {
    return (this.value.stances ?? []).flatMap((stance) => stance.contacts.map((contact) => contact.position_m)).filter(Boolean);
  }
}
