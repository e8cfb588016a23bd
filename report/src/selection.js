// What is selected and tried: one leg, and for a hop a take-off angle inside its feasible window. Every view listens.

export class Selection {
  #listeners = [];

  constructor(mission) {
    this.mission = mission;
    this.leg = mission.legs.length > 0 ? 0 : null;
    /** The take-off angle that is tried for the selected hop; null: the planned one. */
    this.angle_deg = null;
  }

  /** Calls `listener({ leg })` after every change; `leg`: whether another leg was selected. */
  listen(listener) {
    this.#listeners.push(listener);
  }

  get selected() {
    return this.leg === null ? null : this.mission.legs[this.leg];
  }

  /** The arc that is tried, or null where the planned one stands. */
  get tried() {
    return this.angle_deg === null ? null : (this.selected?.arcAt(this.angle_deg) ?? null);
  }

  select(leg) {
    if (leg === this.leg || leg < 0 || leg >= this.mission.legs.length) return;
    this.leg = leg;
    this.angle_deg = null;
    this.#tell(true);
  }

  step(by) {
    if (this.leg !== null) this.select(this.leg + by);
  }

  /** Tries a take-off angle of the selected hop, kept inside its window; null: back to the plan. */
  tryAngle(angle_deg) {
    const window = this.selected?.window_deg;
    if (!window) return;
    this.angle_deg = angle_deg === null ? null : Math.min(window[1], Math.max(window[0], angle_deg));
    this.#tell(false);
  }

  #tell(leg) {
    for (const listener of this.#listeners) listener({ leg });
  }
}

/** Left and right arrows select the legs before and after, wherever the focus is in this element. */
export function selectByArrows(element, selection) {
  element.addEventListener('keydown', (event) => {
    if (event.target instanceof HTMLInputElement || event.altKey || event.ctrlKey || event.metaKey) return;
    const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (by === undefined) return;
    event.preventDefault();
    selection.step(by);
  });
}
