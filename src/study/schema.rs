//! The JSON schemas of everything that is written and read as JSON.

use schemars::{JsonSchema, generate::SchemaSettings};
use serde_json::{Value, json};

use crate::{
    arena::ArenaKeys,
    report::{
        ArenaAnswer, CheckAnswer, CompareAnswer, Document, DocumentKind, DriftAnswer, ExperimentAnswer, FanAnswer, HopAnswer,
        LegsMapAnswer, LegsPlanAnswer, LegsSimulateAnswer, LegsTradeAnswer, MapAnswer, MeshCheckAnswer, MeshHopAnswer,
        MeshMapAnswer, MeshPlanAnswer, MeshSimulateAnswer, PairsAnswer, PlanAnswer, RequireAnswer, SimulateAnswer, SitesAnswer,
        SizeAnswer, StanceAnswer, TargetsAnswer, TargetsSimulateAnswer, TradeAnswer, TravelAnswer, TravelMapAnswer,
        TravelSimulateAnswer,
    },
    scenario::{robot_schema, scenario_schema},
};

/// What a schema describes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SchemaKind {
    /// A scenario.
    Scenario,
    /// A robot file.
    Robot,
    /// The document with an answer.
    Answer(DocumentKind),
}

impl SchemaKind {
    /// All of them, those of files that are written by hand first.
    pub fn all() -> impl Iterator<Item = Self> {
        [Self::Scenario, Self::Robot].into_iter().chain(DocumentKind::ALL.into_iter().map(Self::Answer))
    }

    /// The name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Scenario => "scenario",
            Self::Robot => "robot",
            Self::Answer(kind) => kind.name(),
        }
    }

    /// The JSON schema, draft 2020-12. It stands alone: the schema of an answer contains that of the scenario. A key that it does not
    /// state is refused.
    pub fn schema(self) -> Value {
        match self {
            Self::Scenario => scenario_schema(),
            Self::Robot => robot_schema(),
            Self::Answer(kind) => answer_schema(kind),
        }
    }
}

/// The schema of a document with an answer.
fn answer_schema(kind: DocumentKind) -> Value {
    let mut schema = match kind {
        DocumentKind::Hop => derived::<HopAnswer>(),
        DocumentKind::HopMesh => derived::<MeshHopAnswer>(),
        DocumentKind::Check => derived::<CheckAnswer>(),
        DocumentKind::CheckPairs => derived::<PairsAnswer>(),
        DocumentKind::Plan | DocumentKind::Run => derived::<PlanAnswer>(),
        DocumentKind::CheckMesh => derived::<MeshCheckAnswer>(),
        DocumentKind::PlanMesh | DocumentKind::RunMesh => derived::<MeshPlanAnswer>(),
        DocumentKind::PlanLegs => derived::<LegsPlanAnswer>(),
        DocumentKind::PlanTravel => derived::<TravelAnswer>(),
        DocumentKind::PlanTargets => derived::<TargetsAnswer>(),
        DocumentKind::Simulate => derived::<SimulateAnswer>(),
        DocumentKind::SimulateMesh => derived::<MeshSimulateAnswer>(),
        DocumentKind::SimulateLegs => derived::<LegsSimulateAnswer>(),
        DocumentKind::SimulateTravel => derived::<TravelSimulateAnswer>(),
        DocumentKind::SimulateTargets => derived::<TargetsSimulateAnswer>(),
        DocumentKind::SimulateDrift => derived::<DriftAnswer>(),
        DocumentKind::SimulateExperiment => derived::<ExperimentAnswer>(),
        DocumentKind::Require => derived::<RequireAnswer>(),
        DocumentKind::Trade => derived::<TradeAnswer>(),
        DocumentKind::TradeLegs => derived::<LegsTradeAnswer>(),
        DocumentKind::Compare => derived::<CompareAnswer>(),
        DocumentKind::Fan => derived::<FanAnswer>(),
        DocumentKind::Map => derived::<MapAnswer>(),
        DocumentKind::MapMesh => derived::<MeshMapAnswer>(),
        DocumentKind::MapLegs => derived::<LegsMapAnswer>(),
        DocumentKind::MapTravel => derived::<TravelMapAnswer>(),
        DocumentKind::Sites => derived::<SitesAnswer>(),
        DocumentKind::Size => derived::<SizeAnswer>(),
        DocumentKind::Stance => derived::<StanceAnswer>(),
        DocumentKind::Arena => return arena_schema(),
    };
    close(&mut schema, false);
    open_parts(&mut schema);
    open_tagged(&mut schema);
    schema["title"] = format!("chta {}", kind.name()).into();
    schema["properties"]["schema"]["const"] = kind.schema().into();
    let mut scenario = scenario_schema();
    if let Some(keys) = scenario.as_object_mut() {
        keys.remove("$schema");
        keys.remove("title");
    }
    schema["$defs"]["Scenario"] = scenario;
    let used = json!({ "$ref": "#/$defs/Scenario" });
    schema["properties"]["scenario"] = if kind == DocumentKind::Compare {
        json!({ "description": "The scenarios as used, in SI units and degrees.", "type": "array", "items": used })
    } else {
        json!({ "description": "The scenario as used, in SI units and degrees.", "$ref": used["$ref"] })
    };
    schema
}

/// The schema of an answer in an arena, whose scenario is the arena.
fn arena_schema() -> Value {
    let mut schema = derived::<ArenaAnswer>();
    let mut arena = SchemaSettings::draft2020_12().for_serialize().into_generator().into_root_schema_for::<ArenaKeys>().to_value();
    let parts = arena.as_object_mut().and_then(|keys| keys.remove("$defs"));
    if let Some(keys) = arena.as_object_mut() {
        keys.remove("$schema");
        keys.remove("title");
    }
    for (name, part) in parts.as_ref().and_then(Value::as_object).into_iter().flatten() {
        schema["$defs"][name] = part.clone();
    }
    schema["properties"]["scenario"] = arena;
    close(&mut schema, false);
    open_parts(&mut schema);
    schema["title"] = format!("chta {}", DocumentKind::Arena.name()).into();
    schema["properties"]["schema"]["const"] = DocumentKind::Arena.schema().into();
    schema["properties"]["scenario"]["description"] = "The arena as used, in SI units and degrees.".into();
    schema
}

/// The schema of a document that is written, from its types.
fn derived<T: JsonSchema>() -> Value {
    SchemaSettings::draft2020_12().for_serialize().into_generator().into_root_schema_for::<Document<T>>().to_value()
}

/// The definitions of which the document itself is composed do not know its other keys: the document is closed, they are not.
fn open_parts(document: &mut Value) {
    let parts: Vec<String> = ["anyOf", "oneOf", "allOf"]
        .into_iter()
        .filter_map(|group| document[group].as_array())
        .flatten()
        .filter_map(|part| part["$ref"].as_str()?.strip_prefix("#/$defs/").map(str::to_owned))
        .collect();
    for part in parts {
        if let Some(keys) = document["$defs"][&part].as_object_mut() {
            keys.remove("unevaluatedProperties");
        }
    }
}

/// A definition that a tagged variant consists of does not know the tag: the variant is closed, it is not.
fn open_tagged(document: &mut Value) {
    fn tagged(schema: &Value, names: &mut Vec<String>) {
        if let Some(keys) = schema.as_object() {
            let name = keys.get("$ref").and_then(Value::as_str).and_then(|path| path.strip_prefix("#/$defs/"));
            names.extend(name.filter(|_| keys.contains_key("properties")).map(str::to_owned));
        }
        let (of_object, of_array) = (schema.as_object(), schema.as_array());
        of_object
            .into_iter()
            .flat_map(serde_json::Map::values)
            .chain(of_array.into_iter().flatten())
            .for_each(|part| tagged(part, names));
    }
    let mut names = Vec::new();
    tagged(document, &mut names);
    for name in names {
        if let Some(keys) = document["$defs"][&name].as_object_mut() {
            keys.remove("unevaluatedProperties");
        }
    }
}

/// Lets every object have its stated keys alone. The parts of a composed object do not know each other's keys: only the whole is closed.
fn close(schema: &mut Value, is_part: bool) {
    let has_properties = schema.get("properties").is_some();
    let Some(keys) = schema.as_object_mut() else {
        if let Some(items) = schema.as_array_mut() {
            for item in items {
                close(item, is_part);
            }
        }
        return;
    };
    for (key, value) in keys.iter_mut() {
        match key.as_str() {
            "anyOf" | "oneOf" | "allOf" => close(value, is_part || has_properties),
            "properties" | "$defs" => {
                value.as_object_mut().into_iter().flat_map(serde_json::Map::values_mut).for_each(|value| close(value, false));
            }
            "items" | "prefixItems" | "additionalProperties" | "patternProperties" => close(value, false),
            _ => {}
        }
    }
    if has_properties && !is_part && !keys.contains_key("additionalProperties") {
        keys.insert("unevaluatedProperties".to_owned(), false.into());
    }
}
