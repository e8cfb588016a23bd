//! Results: plain data first; text, JSON, CSV, GeoJSON and the picture are views of it.

mod check_answer;
mod document;
mod experiment_answer;
mod fan_answer;
#[cfg(feature = "plot")]
pub mod figure;
mod geojson;
mod hop_answer;
pub mod landings;
mod path_record;
mod simulate_answer;
mod surest_record;
mod text;
mod whole_file;

pub use check_answer::{CheckAnswer, EffortRecord, EndpointRecord, FrontierRecord, MissRecord, verdict_name};
pub use document::{CrsRecord, Document, InputFile};
pub use experiment_answer::{ConeWidthAnswer, ConeWidthRecord, DriftRecord, RiskTradeAnswer, RiskTradeRow, WorstDriftAnswer};
pub use fan_answer::{BandRecord, FanAnswer, FanRecord};
pub use geojson::{path_geojson, slice_geojson};
pub use hop_answer::{BestRecord, BindingRecord, HopAnswer, LimitRecord, SegmentHopsRecord, VertexRecord};
pub use path_record::{HopRecord, LonLatRecord, MapKnowledge, MapRecord, TotalsRecord, write_path_csv};
pub use simulate_answer::{EllipseRecord, ErrorRecord, LandingRecord, OutcomeRecord, RateRecord, SimulationRecord};
pub use surest_record::{SurestRecord, surest_text};
pub use text::{check_text, hop_text, path_text};
pub use whole_file::{WholeFile, write_whole};
