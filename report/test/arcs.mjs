// Reads hops, one a line (run_m, rise_m, takeoff_angle_deg, gravity_m_s2), and prints what the page's equations make of them.

import { readFileSync } from 'node:fs';
import { Arc, slopeOf } from '../src/arcs.js';

const lines = readFileSync(0, 'utf8').trim().split('\n');
const answers = lines.map((line) => {
  const [run_m, rise_m, angle_deg, gravity_m_s2] = line.split(' ').map(Number);
  const arc = new Arc(run_m, rise_m, slopeOf(angle_deg), gravity_m_s2);
  return [
    arc.takeoff_speed_m_s,
    arc.landing_speed_m_s,
    arc.horizontal_speed_m_s,
    arc.landing_angle_deg,
    arc.flight_time_s,
    arc.apex_height_m,
    ...[0.1, 0.5, 0.93].map((share) => arc.height_at_m(share * run_m)),
  ].join(' ');
});
process.stdout.write(`${answers.join('\n')}\n`);
