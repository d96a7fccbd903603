// Small documents for tests: only what a part reads, with numbers that are easy to find again.

export const mission = (title, outcome, rest = {}) => ({
  title, rank: 1, outcome,
  summary: { mission: title, final_soc_percent: 33.5, reserve_soc_percent: 20, keeps_reserve: outcome === "keeps", energy_wh: 58.77, mechanical_energy_wh: 50.5, compute_energy_wh: 8.27, delivered_energy_wh: 58.77, duration_s: 600, depleted_at_s: null, cut_off_at_s: null, feasible: true, probability_below_reserve: 0.04, ...rest.summary },
  card: { words: outcome === "keeps" ? "keeps reserve" : "runs empty", lead: `Lead of ${title}`, runs: "no software", landing: "33.5 %", aim: "keeps the reserve of 20 %", probability: "96 %", reach_name: "Longest cruise at 95 %", reach: "7 min 44 s", planned: "7 min", help: "", better: "", notes: [], ...rest.card },
  curve: { time_s: [0, 300, 600], soc_percent: [100, 66, 33.5] },
  landing_soc_percent: outcome === "fails" ? null : 33.5, end_s: outcome === "fails" ? 480 : 600,
  band: null, phases: [{ phase: "takeoff", start_s: 0, end_s: 30 }, { phase: "cruise", start_s: 30, end_s: 570 }, { phase: "landing", start_s: 570, end_s: 600 }],
  schedule: [], path: null, ...rest.own,
});

export const grid = (landings, rest = {}) => ({
  x_name: "detection fps", y_name: "encryption key_bits", x: [5, 10], y: [32, 448], others: "", reserve_soc_percent: 20, missions: [0], flights_drawn: 200,
  cells: landings.map((landing, i) => ({ landing_soc_percent: landing, keeps: `${10 * i} %`, utility: i, end_s: 480, duration_s: 600, curve: { time_s: [0, 600], soc_percent: [100, landing ?? 0] } })), ...rest,
});

export const sortie = (rest = {}) => ({
  sortie: 1, in_air_s: 653.9, distance_m: 8390, air_distance_m: 8500, height_m: 81, energy_wh: 5.017, counter_energy_wh: null, energy_closure_percent: null, cruise_airspeed_m_per_s: 14.2,
  duration_s: { takeoff: 27.5, cruise: 569.7, landing: 56.7 }, mean_power_w: { takeoff: 28.5, cruise: 27.3, landing: 30.6 }, ...rest,
});

export const flight = (name, rest = {}) => ({ name, title: name, aircraft: "Wing", date: "", rejected: "", used: "all", text: "", sorties: [sortie()], warnings: [], notes: [], detail: null, ...rest });

/** A document without any part. */
export const empty = () => ({
  format: 1, title: "Title", name: "FlightWatt report", facts: [{ name: "by", text: "flightwatt 0" }], command: "flightwatt report runs", headline: "Headline of the page", aircraft: [], answer: null, panel: null,
  missions: [], quality: [], schedules: null, software: [], packs: [], flights: [], exclusions: [], outlines: [], models: [], physical: null, validation: null, battery: null, trends: null, replay: null, warnings: [], notes: [],
});
