// The arc of one hop in its vertical plane: the equations of src/ballistics/arc.rs, and nothing else.
//
//     z - z_t = m d - (n / X) d^2,   n = m - b,   b = Z / X
//
// X: horizontal distance (m), Z: rise (m), d: distance from the take-off (m), m: take-off slope, n: loft (above 0 for a hop).
// `tests/library/page_arcs.rs` compares every function with the library on 10 000 random hops.

export const slopeOf = (angle_deg) => Math.tan((angle_deg * Math.PI) / 180);
export const angleOf = (slope) => (Math.atan(slope) * 180) / Math.PI;

export class Arc {
  /** The arc over `run_m` and `rise_m` that takes off with a slope, under gravity. */
  constructor(run_m, rise_m, takeoff_slope, gravity_m_s2) {
    this.run_m = run_m;
    this.rise_m = rise_m;
    this.takeoff_slope = takeoff_slope;
    this.gravity_m_s2 = gravity_m_s2;
    this.sight_slope = rise_m / run_m;
    this.loft = takeoff_slope - this.sight_slope;
  }

  /** Slope at the landing, negative on the way down: 2 b - m. */
  get landing_slope() {
    return this.sight_slope - this.loft;
  }

  /** Horizontal speed, constant over the flight: sqrt(g X / (2 n)). */
  get horizontal_speed_m_s() {
    return Math.sqrt((this.gravity_m_s2 * this.run_m) / (2 * this.loft));
  }

  get takeoff_speed_m_s() {
    return this.horizontal_speed_m_s * Math.hypot(1, this.takeoff_slope);
  }

  get landing_speed_m_s() {
    return this.horizontal_speed_m_s * Math.hypot(1, this.landing_slope);
  }

  get takeoff_angle_deg() {
    return angleOf(this.takeoff_slope);
  }

  get landing_angle_deg() {
    return angleOf(this.landing_slope);
  }

  /** Flight time: sqrt(2 X n / g). */
  get flight_time_s() {
    return Math.sqrt((2 * this.run_m * this.loft) / this.gravity_m_s2);
  }

  /** Height of the highest point above the take-off: 0 where the arc never rises, Z where it still rises at the landing. */
  get apex_height_m() {
    if (this.takeoff_slope <= 0) return 0;
    if (this.landing_slope >= 0) return this.rise_m;
    return this.run_m * this.takeoff_slope * (this.takeoff_slope / (4 * this.loft));
  }

  /** Height above the take-off at a distance from it. */
  height_at_m(distance_m) {
    const remaining = (this.run_m - distance_m) / this.run_m;
    return distance_m * (this.sight_slope + this.loft * remaining);
  }

  /** Points [distance, height] from take-off to landing, both included. */
  points(count = 48) {
    const step_m = this.run_m / count;
    return Array.from({ length: count + 1 }, (_, i) => {
      const distance_m = i === count ? this.run_m : i * step_m;
      return [distance_m, i === count ? this.rise_m : this.height_at_m(distance_m)];
    });
  }
}
