//! Results as plain data; text, JSON, CSV and GeoJSON are views of it.

mod advice;
mod arena_answer;
mod check_answer;
mod compare_answer;
mod density_record;
mod derating_record;
mod document;
mod drift_answer;
mod experiment_answer;
mod fan_answer;
mod geojson;
mod hop_answer;
mod hop_margins;
mod joints_record;
pub mod landings;
mod legs_map_answer;
mod legs_plan_answer;
mod legs_simulate_answer;
mod legs_trade_answer;
mod legs_walk_record;
mod limit_counts;
mod limit_pair;
mod map_answer;
mod mesh_check_answer;
mod mesh_hop_answer;
mod mesh_map_answer;
mod mesh_plan_answer;
mod mesh_simulate_answer;
mod objective_record;
mod outage_record;
#[cfg(feature = "plot")]
mod page;
#[cfg(feature = "parquet")]
mod parquet_table;
mod path_record;
mod plan_answer;
mod proof_record;
mod propellant_record;
mod reliability_record;
mod require_answer;
mod require_text;
mod route_record;
mod sensitivity_answer;
mod sigma_margins;
mod simulate_answer;
mod sites_answer;
mod size_answer;
mod stance_answer;
mod stated;
mod success_record;
mod targets_answer;
mod targets_text;
mod text;
mod trade_answer;
mod trajectory;
mod travel_answer;
mod travel_map_answer;
mod travel_simulate_answer;
mod travel_text;

pub use advice::AdviceRecord;
pub use arena_answer::{ArenaAnswer, ArenaComparedRecord, ArenaFlightRecord, ArenaHistoryRecord, ArenaPointRecord, arena_text};
pub use check_answer::{
    CheckAnswer, EffortRecord, EndpointRecord, FrontierRecord, JourneyEnd, MissRecord, PairsAnswer, verdict_of,
};
pub use compare_answer::{CompareAnswer, CompareRow, MarginsRecord};
pub use density_record::DensityRecord;
pub use derating_record::DeratingRecord;
pub use document::{CrsRecord, Document, DocumentKind, DocumentProblem, InputFile};
pub use drift_answer::{DriftAnswer, drift_text};
pub use experiment_answer::{ConeWidthAnswer, ConeWidthRecord, DriftRecord, ExperimentAnswer, WorstDriftAnswer};
pub use fan_answer::{BandRecord, FanAnswer, FanRecord};
pub use geojson::{mission_geojson, path_geojson, paths_geojson, slice_geojson};
pub use hop_answer::{
    BestRecord, BindingRecord, GreatestReachRecord, HopAnswer, LimitRecord, SegmentHopsRecord, VertexRecord, WindowEndRecord,
    WindowRecord,
};
pub use hop_margins::HopMarginsRecord;
pub use joints_record::{FootJointsRecord, FootPushRecord, JointReachRecord, JointRecord, PushRecord};
pub use legs_map_answer::{LegsGoalRecord, LegsMapAnswer, LegsReachRecord, LimbNodesRecord};
pub use legs_plan_answer::{LegsGroundKind, LegsGroundRecord, LegsPlanAnswer, RefusedPosesRecord, StanceRecord, legs_plan_text};
pub use legs_simulate_answer::{EndedInHopRecord, LegsOutcomeRecord, LegsSimulateAnswer, LegsTrialsRecord, legs_simulate_text};
pub use legs_trade_answer::{LegsTradeAnswer, LegsTradeRow};
pub use legs_walk_record::LegsWalkRecord;
pub use limit_counts::LimitCounts;
pub use limit_pair::LimitPair;
pub use map_answer::{
    GoalRecord, MapAnswer, MapBudgetRecord, MapEffortRecord, MapObjectiveRecord, MapSummary, MobilityRecord, ReturnRecord,
    StartRecord,
};
pub use mesh_check_answer::{MeshCheckAnswer, ViolationRecord, mesh_check_text};
pub use mesh_hop_answer::{
    MeshBallRecord, MeshBindingRecord, MeshBlockedRecord, MeshContactRecord, MeshFacetRecord, MeshHopAnswer, MeshLimitRecord,
    MeshWindowEndRecord, MeshWindowRecord, mesh_hop_text,
};
pub use mesh_map_answer::{
    MapContactRow, MapContactsRecord, MapRoundRecord, MeshGoalRecord, MeshMapAnswer, MeshReturnRecord, ReachedRecord,
    mesh_map_text, write_map_contacts_csv,
};
pub(crate) use mesh_plan_answer::hops_of;
pub use mesh_plan_answer::{
    MeshPlanAnswer, RoadmapGapRecord, RoadmapRecord, RoadmapRoundRecord, SampledHopsRecord, mesh_plan_text,
};
pub use mesh_simulate_answer::{MeshSimulateAnswer, mesh_simulate_text};
pub use objective_record::{AmountRecord, BudgetRecord, ObjectiveRecord};
pub use outage_record::OutageRecord;
#[cfg(feature = "plot")]
pub use page::{PageDocument, PageFacets, PageGround, PageLayer, PagePosts, ProfileCut, ProfilePiece, page_html, page_template};
#[cfg(feature = "parquet")]
pub use parquet_table::{CellKind, TableColumn, TextTable, read_parquet, write_parquet};
pub use path_record::{
    AimRecord, EnergyBasis, HopRecord, LonLatRecord, MapKnowledge, MapRecord, TotalsRecord, write_path_csv, write_paths_csv,
};
pub use plan_answer::{PlanAnswer, plan_text};
pub use proof_record::{GapRecord, ProofRecord, ProofSummaryRecord, StretchRecord};
pub use propellant_record::{PropellantShortage, StoresRecord};
pub use reliability_record::{ReliablePathRecord, SuccessEstimate, reliable_paths_text};
pub use require_answer::{BudgetsTry, RequireAnswer, RequireBudgetsRecord, RequireSuccessRecord, RequireTry, SuccessTry};
pub use require_text::require_text;
pub use route_record::{QuestionRouteRecord, RouteGapRecord, RouteKind, RouteRecord};
pub use sensitivity_answer::{SensitivityAnswer, SensitivityRow};
pub use sigma_margins::SigmaMarginsRecord;
pub use simulate_answer::{
    EllipseRecord, ErrorRecord, FailureRecord, LandingRecord, OutcomeRecord, RateRecord, SimulateAnswer, SimulationRecord,
    SuccessRequirement, simulate_text,
};
pub use sites_answer::{SiteRecord, SitesAnswer};
pub use size_answer::{SizeAnswer, SizeRecord};
pub use stance_answer::{
    BeamRecord, ElevationRecord, FootRecord, PoseRecord, RoseRecord, StanceAnswer, TriedPoses, heading_of, stance_text,
};
pub use success_record::{
    FrontRecord, FrontSearchRecord, FrontSuccess, SuccessBudgetRecord, amount_front_text, estimate_ci95, front_text,
};
pub use targets_answer::{
    LeftOutRecord, OverBudgetRecord, TargetHopRecord, TargetRecord, TargetsAnswer, TargetsSearchRecord, TargetsSimulateAnswer,
    TripRecord, VisitRecord, VisitedRecord, WhyRecord, write_target_hops_csv,
};
pub use targets_text::{targets_simulate_text, targets_text};
pub use text::{FurtherMeans, check_text, hop_text, path_text};
pub use trade_answer::{SweptKeyRecord, TradeAnswer, TradeRow, with_unit};
pub use trajectory::{trajectory_columns, write_trajectory_csv};
pub use travel_answer::{
    DriveLegRecord, DriveMarginsRecord, DriveRefusalRecord, HopLegRecord, TravelAlternativeRecord, TravelAnswer, TravelFrontRecord,
    TravelLegRecord, TravelSearchRecord, TravelStopRecord, TravelSumsRecord, TravelTotalsRecord, write_travel_csv,
};
pub use travel_map_answer::{TravelGoalRecord, TravelMapAnswer, TravelReachRecord};
pub use travel_simulate_answer::{
    EndedInLegRecord, TravelOutcomeRecord, TravelSimulateAnswer, TravelTrialsRecord, travel_simulate_text,
};
pub use travel_text::travel_text;
