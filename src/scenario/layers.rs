//! `[layer.NAME]`: rasters with a condition on contacts or flights.

use std::path::PathBuf;

use serde_json::{Map, Value};

use super::{Entries, Kind, ProblemKind, Route, Scenario, TerrainSource, values::number};
use crate::{
    planner::{Amount, LayerTotals, Objective, TotalBudget},
    terrain::{LayerCondition, LayerCost, LayerRule, OutageLimit},
    world::LayerName,
};

/// A layer of a scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct LayerKeys {
    /// What it asks for.
    pub rule: LayerRule,
    /// Path of its raster, relative to the scenario's folder.
    pub raster: PathBuf,
}

/// The keys of a layer with their meanings.
pub(super) const LAYER_KEYS: [(&str, &str); 11] = [
    ("raster", "raster on the terrain's map, path from this file"),
    ("min", "the layer holds where the raster's value is at least this"),
    ("max", "the layer holds where the raster's value is at most this"),
    ("equals", "the layer holds where the raster's value is this, as 255 where gdal_viewshed sees"),
    (
        "applies_to",
        "contact: take-offs, landings and driven ground; flight: all ground flown over; or a list of both; absent: contact",
    ),
    (
        "outage_max_s",
        "on a free route of hops: the longest time in which the layer may not hold, at a stretch, s; absent: it always holds",
    ),
    ("outage_hops_max", "the same as a number of hops, those into the stretch and out of it included"),
    ("exempt_targets", "whether the layer counts as holding at contacts with the goal or targets; absent: false"),
    (
        COST_PER_CONTACT,
        "on a free route of hops: what a landing costs, this times the value of its cell; at least 0; absent: nothing",
    ),
    (COST_PER_M, "the same for each metre of ground flown over, by the values of the cells under the flight"),
    (TOTAL_MAX, "the greatest cost of a path by this layer, in all; absent: any"),
];

const COST_PER_CONTACT: &str = "cost_per_contact";
const COST_PER_M: &str = "cost_per_m";
const TOTAL_MAX: &str = "total_max";

/// The kind of a key of a layer; `None` for an unknown one.
pub fn kind_of_layer_key(name: &str) -> Option<Kind> {
    let (key, _) = LAYER_KEYS.into_iter().find(|(key, _)| *key == name)?;
    let from_zero = Kind::Number { min: 0.0, max: f64::MAX };
    Some(match key {
        "min" | "max" | "equals" => Kind::Number { min: f64::MIN, max: f64::MAX },
        "outage_max_s" | COST_PER_CONTACT | COST_PER_M | TOTAL_MAX => from_zero,
        "outage_hops_max" => Kind::Count { min: 0, max: u64::from(u32::MAX) },
        "exempt_targets" => Kind::Flag,
        _ => Kind::Text,
    })
}

/// The keys of a layer, for a sentence.
pub fn layer_keys() -> String {
    LAYER_KEYS.map(|(key, _)| key).join(", ")
}

/// The words of `applies_to`.
pub(super) const APPLIES_TO: [&str; 2] = ["contact", "flight"];

/// The layers, in the order of their names.
pub(super) fn layers(entries: &mut Entries, terrain: Option<&TerrainSource>) -> Vec<LayerKeys> {
    let mut found = Vec::new();
    for name in entries.names_in("layer") {
        let misplaced = match terrain {
            Some(TerrainSource::Chain { .. }) => Some("a chain"),
            Some(TerrainSource::MeshInSpace { .. }) => Some("a mesh with a free route"),
            _ => None,
        };
        if let Some(what) = misplaced {
            let message = format!("layer.{name} is laid over a map, but terrain has {what}");
            entries.problem(("layer", &name), ProblemKind::Misplaced, message, "remove it, or give a dem");
        }
        match entries.value("layer", &name).and_then(toml::Value::as_table).map(|table| layer(&name, table)) {
            Some(Ok(layer)) => found.push(layer),
            Some(Err((message, help))) => entries.problem(("layer", &name), ProblemKind::Value, message, help),
            None => {}
        }
    }
    found
}

/// One layer, or what is wrong with it and how to mend it.
fn layer(name: &str, table: &toml::Table) -> Result<LayerKeys, (String, String)> {
    let known = LayerName::new(name).ok_or_else(|| {
        let message =
            format!("layer.{name} has a name that a limit cannot have, expected 1 to 64 of the letters a to z, digits, _ and -");
        (message, "rename the layer, such as [layer.sun]".to_owned())
    })?;
    if let Some(unknown) = table.keys().find(|key| LAYER_KEYS.iter().all(|(known, _)| known != key)) {
        return Err((format!("unknown key layer.{name}.{unknown}"), format!("the keys of a layer are {}", layer_keys())));
    }
    let meaning = |key: &str| {
        let of_key = LAYER_KEYS.iter().find(|(known, _)| *known == key);
        format!("it means: {}", of_key.map_or("", |(_, meaning)| meaning))
    };
    let raster = match table.get("raster") {
        Some(toml::Value::String(path)) if !path.trim().is_empty() => PathBuf::from(path),
        Some(other) => return Err((format!("layer.{name}.raster is {other}, expected a path in quotes"), meaning("raster"))),
        None => return Err((format!("layer.{name} has no raster"), meaning("raster"))),
    };
    let bound = |key: &str| match table.get(key) {
        None => Ok(None),
        Some(value) => match number(value).filter(|number| number.is_finite()) {
            Some(number) => Ok(Some(number)),
            None => Err((format!("layer.{name}.{key} is {value}, expected a finite number"), meaning(key))),
        },
    };
    let condition = LayerCondition { min: bound("min")?, max: bound("max")?, equals: bound("equals")? };
    let cost = cost(name, table, &meaning)?;
    match condition {
        LayerCondition { min: None, max: None, equals: None } if cost.is_none() => {
            let help = "say which values hold, such as min = 0.3, or what they cost, such as cost_per_contact = 1".to_owned();
            return Err((format!("layer.{name} has no condition, expected min, max or equals"), help));
        }
        LayerCondition { min: None, max: None, equals: None } => {
            let of_condition = ["applies_to", "outage_max_s", "outage_hops_max", "exempt_targets"];
            if let Some(key) = of_condition.into_iter().find(|key| table.contains_key(*key)) {
                let message = format!("layer.{name} has {key} without a condition, expected min, max or equals beside it");
                return Err((message, format!("remove {key}, or give a condition")));
            }
        }
        LayerCondition { min, max, equals: Some(_) } if min.is_some() || max.is_some() => {
            let message = format!("layer.{name} has equals beside min or max, expected one of the two");
            return Err((message, "remove one of them".to_owned()));
        }
        LayerCondition { min: Some(min), max: Some(max), .. } if min > max => {
            let message = format!("layer.{name} has a min of {min} above its max of {max}, so that it holds nowhere");
            return Err((message, "exchange them, or remove one".to_owned()));
        }
        _ => {}
    }
    let [on_contact, on_flight] = match table.get("applies_to") {
        None => [condition != LayerCondition::default(), false],
        Some(value) => {
            let words =
                value.as_array().map_or_else(|| vec![value.as_str()], |words| words.iter().map(toml::Value::as_str).collect());
            let are_known = !words.is_empty() && words.iter().all(|word| word.is_some_and(|word| APPLIES_TO.contains(&word)));
            if !are_known {
                let message = format!("layer.{name}.applies_to is {value}, expected \"contact\", \"flight\" or a list of both");
                return Err((message, meaning("applies_to")));
            }
            APPLIES_TO.map(|word| words.contains(&Some(word)))
        }
    };
    let outage = outage(name, table, &meaning)?;
    Ok(LayerKeys { rule: LayerRule { name: known, condition, on_contact, on_flight, outage, cost }, raster })
}

impl Scenario {
    /// The greatest totals of a path, each with its key: those of `[budget]`, of the propellant, and of layers with a cost.
    pub fn limited_totals(&self) -> Vec<TotalBudget> {
        let own = self.budget.totals(&self.hopper);
        own.into_iter().chain(self.layers.iter().filter_map(LayerKeys::total_budget)).collect()
    }
}

impl LayerKeys {
    /// The greatest cost of a path.
    pub(super) fn total_budget(&self) -> Option<TotalBudget> {
        let most = self.rule.cost?.total_max?;
        Some(TotalBudget { amount: Amount::Layer(self.rule.name), key: TOTAL_MAX, most })
    }
}

impl Entries {
    /// Forgets what layers cost, where hops are judged each by itself.
    ///
    /// # Returns
    /// The names of the layers.
    pub fn forget_costs_of_layers(&mut self) -> Vec<String> {
        let keys = [COST_PER_CONTACT, COST_PER_M, TOTAL_MAX];
        let mut names = self.names_in("layer");
        let has = |table: &toml::Table, keys: &[&str]| keys.iter().any(|key| table.contains_key(*key));
        names.retain(|name| self.value("layer", name).and_then(toml::Value::as_table).is_some_and(|table| has(table, &keys)));
        for name in &names {
            let has_condition = self.layer_table_mut(name).is_some_and(|table| {
                table.retain(|key, _| !keys.contains(&key));
                has(table, &["min", "max", "equals"])
            });
            if !has_condition {
                self.forget("layer", name);
            }
        }
        names
    }

    /// Forgets the layers that may be left for a while: where hops are judged each by itself, they refuse none.
    ///
    /// # Returns
    /// Their names.
    pub fn forget_layers_with_outages(&mut self) -> Vec<String> {
        let is_left =
            |table: &toml::Table| ["outage_max_s", "outage_hops_max", "exempt_targets"].iter().any(|key| table.contains_key(*key));
        let mut names = self.names_in("layer");
        names.retain(|name| self.value("layer", name).and_then(toml::Value::as_table).is_some_and(is_left));
        for name in &names {
            self.forget("layer", name);
        }
        names
    }
}

/// What a layer costs; `None` without a key of it.
fn cost(name: &str, table: &toml::Table, meaning: &dyn Fn(&str) -> String) -> Result<Option<LayerCost>, (String, String)> {
    let of_key = |key: &str| match table.get(key) {
        None => Ok(None),
        Some(value) => match number(value).filter(|number| *number >= 0.0 && number.is_finite()) {
            Some(number) => Ok(Some(number)),
            None => Err((format!("layer.{name}.{key} is {value}, expected a number of at least 0"), meaning(key))),
        },
    };
    let [per_contact, per_m, total_max] = [of_key(COST_PER_CONTACT)?, of_key(COST_PER_M)?, of_key(TOTAL_MAX)?];
    let [has_contact, has_flight] = [per_contact, per_m].map(|factor| factor.is_some_and(|factor| factor > 0.0));
    if !has_contact && !has_flight {
        return match [(COST_PER_CONTACT, per_contact), (COST_PER_M, per_m), (TOTAL_MAX, total_max)]
            .into_iter()
            .find(|key| key.1.is_some())
        {
            None => Ok(None),
            Some((key, _)) => {
                let message =
                    format!("layer.{name} has {key} and costs nothing, expected a cost_per_contact or a cost_per_m above 0");
                Err((message, format!("give a cost, or remove {key}")))
            }
        };
    }
    Ok(Some(LayerCost { per_contact: per_contact.unwrap_or(0.0), per_m: per_m.unwrap_or(0.0), total_max }))
}

/// For how long a layer may be left; `None` without a key of it.
fn outage(name: &str, table: &toml::Table, meaning: &dyn Fn(&str) -> String) -> Result<Option<OutageLimit>, (String, String)> {
    let max_s =
        match table.get("outage_max_s").map(|value| (value, number(value).filter(|time_s| *time_s >= 0.0 && time_s.is_finite()))) {
            Some((value, None)) => {
                let message = format!("layer.{name}.outage_max_s is {value}, expected a number of at least 0");
                return Err((message, meaning("outage_max_s")));
            }
            Some((_, time_s)) => time_s,
            None => None,
        };
    let hops_max =
        match table.get("outage_hops_max").map(|value| (value, value.as_integer().and_then(|hops| u32::try_from(hops).ok()))) {
            Some((value, None)) => {
                let message = format!("layer.{name}.outage_hops_max is {value}, expected a whole number of at least 0");
                return Err((message, meaning("outage_hops_max")));
            }
            Some((_, hops)) => hops,
            None => None,
        };
    let exempt_targets = match table.get("exempt_targets").map(|value| (value, value.as_bool())) {
        Some((value, None)) => {
            let message = format!("layer.{name}.exempt_targets is {value}, expected true or false");
            return Err((message, meaning("exempt_targets")));
        }
        Some((_, exempt)) => exempt.unwrap_or(false),
        None => false,
    };
    let limit = OutageLimit { max_s, hops_max, exempt_targets };
    Ok((limit != OutageLimit::default()).then_some(limit))
}

/// Refuses what counts along whole paths, outages and costs, where paths are no free routes of hops alone; more costs than a path has totals
/// for; and an objective by a layer that has no cost.
pub(super) fn check_of_paths(entries: &mut Entries, layers: &[LayerKeys], route: Route, drives: bool) {
    for layer in layers.iter().filter(|_| route != Route::Free || drives) {
        let LayerRule { name, outage, cost, .. } = layer.rule;
        let (is, keys) = match (outage, cost) {
            (Some(_), _) => ("may be left for a while", "the keys of the outage"),
            (None, Some(_)) => ("has a cost", "the keys of the cost"),
            (None, None) => continue,
        };
        let (found, help) = if drives {
            ("not with the wheels of [drive]", format!("remove [drive], or {keys}"))
        } else {
            ("not along transects and on maps", format!("set terrain.route = \"free\" and plan a route, or remove {keys}"))
        };
        let message = format!("layer.{name} {is}, which counts along free routes of hops alone, {found}");
        entries.problem(("layer", name.name()), ProblemKind::Misplaced, message, help);
    }
    let mut with_cost = layers.iter().filter(|layer| layer.rule.cost.is_some()).map(|layer| layer.rule.name);
    if let Some(beyond) = with_cost.clone().nth(LayerTotals::MOST) {
        let message =
            format!("layer.{beyond} has a cost beside {} others, expected at most {0} layers with one", LayerTotals::MOST);
        entries.problem(
            ("layer", beyond.name()),
            ProblemKind::Conflict,
            message,
            "remove the cost of one, or add their rasters up",
        );
    }
    let objective = entries.objective("search", "objective");
    let mut of_layers = objective.iter().flat_map(Objective::amounts).filter_map(|amount| amount.layer());
    if let Some(wanted) = of_layers.find(|wanted| !with_cost.any(|known| known == *wanted)) {
        let message = format!("search.objective has layer:{wanted}, but no layer of that name has a cost");
        let help = format!("give layer.{wanted} a raster and a cost_per_contact or a cost_per_m, or remove it from the objective");
        entries.problem(("search", "objective"), ProblemKind::Missing, message, help);
    }
}

/// The layers as a document that reads back.
pub(super) fn document(layers: &[LayerKeys], named: &dyn Fn(&std::path::Path) -> String) -> Value {
    let of = |layer: &LayerKeys| {
        let LayerRule { name, condition, on_contact, on_flight, outage, cost } = layer.rule;
        let numbers = [("min", condition.min), ("max", condition.max), ("equals", condition.equals)];
        let applies_to = match (on_contact, on_flight) {
            (true, true) => Some(Value::from(APPLIES_TO.to_vec())),
            (true, false) => Some(APPLIES_TO[0].into()),
            (false, true) => Some(APPLIES_TO[1].into()),
            (false, false) => None,
        };
        let factor = |of: fn(LayerCost) -> f64| cost.map(of).filter(|factor| *factor > 0.0).map(Value::from);
        let keys = [
            ("raster", Some(Value::from(named(&layer.raster)))),
            ("applies_to", applies_to),
            ("outage_max_s", outage.and_then(|limit| limit.max_s).map(Value::from)),
            ("outage_hops_max", outage.and_then(|limit| limit.hops_max).map(Value::from)),
            ("exempt_targets", outage.filter(|limit| limit.exempt_targets).map(|_| Value::from(true))),
            (COST_PER_CONTACT, factor(|cost| cost.per_contact)),
            (COST_PER_M, factor(|cost| cost.per_m)),
            (TOTAL_MAX, cost.and_then(|cost| cost.total_max).map(Value::from)),
        ];
        let stated = numbers.into_iter().map(|(key, number)| (key, number.map(Value::from))).chain(keys);
        let stated: Map<_, _> = stated.filter_map(|(key, value)| Some((key.to_owned(), value?))).collect();
        (name.name().to_owned(), Value::Object(stated))
    };
    Value::Object(layers.iter().map(of).collect())
}

#[cfg(test)]
mod tests {
    use crate::{
        scenario::{Entries, Scenario, scenario_document},
        terrain::{LayerCost, OutageLimit},
    };

    const HEAD: &str = "[body]\nname = \"moon\"\n[terrain]\ndem = \"x.tif\"\nstart_m = [0, 0]\ngoal_m = [1, 1]\n";

    #[test]
    fn wrong_layers_are_refused_with_their_names() {
        for (layer, words) in [
            ("[layer.sun]\nmin = 1", ["layer.sun has no raster", "path from this file"]),
            ("[layer.sun]\nraster = \"a.tif\"", ["no condition", "min = 0.3"]),
            ("[layer.sun]\nraster = \"a.tif\"\nmim = 1", ["unknown key layer.sun.mim", "raster, min, max, equals"]),
            ("[layer.sun]\nraster = \"a.tif\"\nmin = \"high\"", ["layer.sun.min is \"high\"", "at least this"]),
            ("[layer.sun]\nraster = \"a.tif\"\nmin = 2\nmax = 1", ["min of 2 above its max of 1", "exchange"]),
            ("[layer.sun]\nraster = \"a.tif\"\nmin = 2\nequals = 1", ["equals beside min", "remove one"]),
            ("[layer.sun]\nraster = \"a.tif\"\nmin = 2\napplies_to = \"hop\"", ["applies_to is \"hop\"", "contact"]),
            ("[layer.sun]\nraster = \"a.tif\"\nmin = 2\napplies_to = []", ["applies_to is []", "contact"]),
            ("[layer.sun]\nraster = \"a.tif\"\nmin = 2\noutage_max_s = -1", ["outage_max_s is -1", "at a stretch"]),
            ("[layer.sun]\nraster = \"a.tif\"\nmin = 2\noutage_hops_max = 1.5", ["outage_hops_max is 1.5", "into the stretch"]),
            ("[layer.sun]\nraster = \"a.tif\"\nmin = 2\nexempt_targets = 1", ["exempt_targets is 1", "counts as holding"]),
            ("[layer.sun]\nraster = \"a.tif\"\ncost_per_m = -1", ["cost_per_m is -1", "each metre"]),
            ("[layer.sun]\nraster = \"a.tif\"\ncost_per_m = 0", ["cost_per_m and costs nothing", "remove cost_per_m"]),
            ("[layer.sun]\nraster = \"a.tif\"\nmin = 1\ntotal_max = 3", ["total_max and costs nothing", "give a cost"]),
            (
                "[layer.sun]\nraster = \"a.tif\"\ncost_per_m = 1\napplies_to = \"flight\"",
                ["applies_to without a condition", "remove"],
            ),
            ("[layer.sun]\nraster = \"a.tif\"\ncost_per_contact = 1", ["has a cost, which counts", "route = \"free\""]),
            ("[layer.sun]\nraster = \"a.tif\"\nmin = 1\n[search]\nobjective = [\"layer:sun\"]", ["layer:sun", "cost_per_contact"]),
            ("[layer.sun]\nraster = \"a.tif\"\nmin = 2\noutage_max_s = 9", ["free routes of hops alone", "route = \"free\""]),
            ("[layer.\"s n\"]\nraster = \"a.tif\"\nmin = 2", ["a limit cannot have", "rename"]),
            ("[layer]\nsun = 3", ["layer.NAME is 3", "raster"]),
        ] {
            let problems = Scenario::new(Entries::from_toml(&format!("{HEAD}{layer}\n"))).unwrap_err();
            let text = format!("{} {}", problems[0].message, problems[0].help);
            assert!(words.iter().all(|word| text.contains(word)), "{layer}: {text}");
        }
        let on_chain = "[body]\nname = \"moon\"\n[terrain]\nchain = \"x.csv\"\n[layer.sun]\nraster = \"a.tif\"\nmin = 1\n";
        let problems = Scenario::new(Entries::from_toml(on_chain)).unwrap_err();
        assert!(problems[0].message.contains("layer.sun is laid over a map"), "{problems:?}");
    }

    #[test]
    fn layers_read_back_and_their_keys_are_set_one_by_one() {
        let text = "[layer.sun]\nraster = \"a.tif\"\nmin = 0.25\n[layer.link]\nraster = \"b.tif\"\nequals = 255\napplies_to = [\"flight\", \"contact\"]\n";
        let mut entries = Entries::from_toml(&format!("{HEAD}{text}"));
        entries.set("--set", "layer.sun.max=0.75");
        entries.set("--set", "layer.sun.applies_to=flight");
        entries.set("--set", "layer.hazard={ raster = \"c.tif\", max = 1 }");
        entries.set("--set", "terrain.route=free");
        entries.set("--set", "layer.sun.outage_max_s=1200");
        entries.set("--set", "layer.sun.outage_hops_max=3");
        entries.set("--set", "layer.link.exempt_targets=true");
        entries.set("--set", "layer.cold={ raster = \"d.tif\", cost_per_m = 0.5, total_max = 9 }");
        entries.set("--set", "layer.sun.cost_per_contact=2");
        entries.set("--set", "search.objective=['layer:cold', 'hops']");
        let scenario = Scenario::new(entries).unwrap();
        let names: Vec<&str> = scenario.layers.iter().map(|layer| layer.rule.name.name()).collect();
        assert_eq!(names, ["cold", "hazard", "link", "sun"]);
        let sun = scenario.layers[3].rule;
        let cold = scenario.layers[0].rule;
        assert_eq!((cold.on_contact, cold.on_flight), (false, false));
        assert_eq!(cold.cost, Some(LayerCost { per_contact: 0.0, per_m: 0.5, total_max: Some(9.0) }));
        assert_eq!(sun.cost, Some(LayerCost { per_contact: 2.0, per_m: 0.0, total_max: None }));
        let totals = scenario.limited_totals();
        assert_eq!((totals.len(), totals[0].full_key().as_str(), totals[0].most), (1, "layer.cold.total_max", 9.0));
        assert!(scenario.plans_by_objective());
        assert_eq!((sun.condition.min, sun.condition.max, sun.on_contact, sun.on_flight), (Some(0.25), Some(0.75), false, true));
        assert!(scenario.layers[2].rule.on_contact && scenario.layers[2].rule.on_flight);
        let limit = |number: usize| scenario.layers[number + 1].rule.outage;
        assert_eq!(limit(0), None);
        assert_eq!(limit(1), Some(OutageLimit { max_s: None, hops_max: None, exempt_targets: true }));
        assert_eq!(limit(2), Some(OutageLimit { max_s: Some(1200.0), hops_max: Some(3), exempt_targets: false }));
        // Targets alone are exempt: nowhere else may the layer be left.
        assert_eq!(limit(1).map(|limit| (limit.most_s(), limit.most_hops())), Some((f64::INFINITY, 0.0)));
        let document = scenario_document(&scenario, &|path| path.to_string_lossy().into_owned());
        assert_eq!(Scenario::from_document(&document).as_ref(), Ok(&scenario));
    }
}
