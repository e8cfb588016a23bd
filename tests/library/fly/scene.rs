//! Journeys to simulate: on a flat chain, on a rough one, on the shipped DEM.

use std::sync::Arc;

use chta::{
    ballistics::TakeoffChoice,
    chain::{ConstrainedChain, PolygonalChain, Station},
    graph::{CostToGo, NodeSet, Outcome, PointSpacing, SearchOptions, search},
    ground::{DemGround, Surface},
    hop::{HopTest, Split},
    path::{HopPath, generate},
    quantity::{Angle, AngleInterval, ChainPoint, MapPoint},
    terrain::{Dem, OverlaidDem, Overlays, slice},
    uncertainty::{Mission, Simulation, Summary, TrialOptions, Uncertainty},
    world::{ClearanceRule, FrictionCone, Gravity, Grip, Hopper, HopperLimits, RestSlope, SurfaceProperties},
};

/// A journey and the ground of its plan.
pub(crate) struct Scene {
    pub(crate) chain: ConstrainedChain,
    pub(crate) hopper: Hopper,
    pub(crate) surface: SurfaceProperties,
    pub(crate) gravity_m_s2: f64,
    pub(crate) dem: Option<Dem>,
    pub(crate) options: SearchOptions,
    pub(crate) ends_m: (f64, f64),
}

/// A scene with its plan.
pub(crate) struct Planned<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) test: HopTest,
    pub(crate) path: HopPath,
    pub(crate) to_go: Arc<CostToGo>,
    pub(crate) start: Station,
    pub(crate) goal: Station,
}

pub(crate) fn friction(coefficient: f64) -> SurfaceProperties {
    let cone = FrictionCone::new(coefficient).unwrap();
    SurfaceProperties { grip: Some(Grip::Friction(cone)), rest: RestSlope::AsFrictionHolds }
}

/// The middle of the feasible angles leaves a margin for errors in both directions.
pub(crate) fn mid_range(spacing: PointSpacing) -> SearchOptions {
    SearchOptions { spacing: Some(spacing), takeoff: TakeoffChoice::MidRange, ..SearchOptions::default() }
}

impl Scene {
    pub(crate) fn of_chain(points: &[(f64, f64)], speed_m_s: f64, surface: SurfaceProperties) -> Self {
        let vertices = points.iter().map(|&(x, z)| ChainPoint::new(x, z)).collect();
        let limits = HopperLimits {
            clearance_m: 0.05,
            clearance_rule: ClearanceRule::Vertex,
            ..HopperLimits::with_speeds(speed_m_s, speed_m_s)
        };
        let hopper = Hopper::new(limits).unwrap();
        let chain = ConstrainedChain::new(PolygonalChain::bare(vertices).unwrap(), &hopper, Gravity::new(3.711).unwrap(), &surface)
            .unwrap();
        let ends_m = chain.geometry().extent_m();
        let options = mid_range(PointSpacing::PerSegment(3));
        Self { chain, hopper, surface, gravity_m_s2: 3.711, dem: None, options, ends_m }
    }

    /// One hop over flat ground of 400 m, from 100 to 140 m, cones wide open.
    pub(crate) fn flat() -> Self {
        let open = SurfaceProperties {
            grip: Some(Grip::FromSlope {
                takeoff: AngleInterval::from_degrees(0.0, 180.0),
                landing: AngleInterval::from_degrees(-180.0, 0.0),
            }),
            rest: RestSlope::Unlimited,
        };
        let mut scene = Self::of_chain(&[(0.0, 2.0), (400.0, 2.0)], 30.0, open);
        scene.ends_m = (100.0, 140.0);
        scene.options = mid_range(PointSpacing::PerSegment(0));
        scene
    }

    /// Rolling ground of 100 vertices.
    pub(crate) fn rolling() -> Self {
        let height = |i: u32| 1.2 * libm::sin(f64::from(i) * 0.23) + 0.3 * libm::sin(f64::from(i) * 1.9 + 1.0);
        let points: Vec<(f64, f64)> = (0..100).map(|i| (f64::from(i), height(i))).collect();
        let mut scene = Self::of_chain(&points, 9.0, friction(0.9));
        scene.ends_m = (8.0, 90.0);
        scene.options = mid_range(PointSpacing::PerSegment(1));
        scene
    }

    /// A slice of a DEM between two map points.
    pub(crate) fn of_dem(dem: Dem, ends: [(f64, f64); 2], hopper: Hopper, surface: SurfaceProperties, gravity_m_s2: f64) -> Self {
        let [from, to] = ends.map(|(x, y)| MapPoint::new(x, y));
        let profile = slice(&dem, from, to).unwrap();
        let Some(Grip::Friction(cone)) = surface.grip else { panic!("a slice needs friction") };
        let chain = PolygonalChain::from_profile(&profile, Some(cone)).unwrap();
        let chain = ConstrainedChain::new(chain, &hopper, Gravity::new(gravity_m_s2).unwrap(), &surface).unwrap();
        let ends_m = chain.geometry().extent_m();
        Self { chain, hopper, surface, gravity_m_s2, dem: Some(dem), options: mid_range(PointSpacing::AtMostM(1.0)), ends_m }
    }

    /// The shipped crater field.
    pub(crate) fn craters() -> Self {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/data/terrain/mars_crater_field.tif");
        let dem = chta::terrain::read_dem(file.as_ref()).unwrap();
        let hopper = Hopper::new(HopperLimits { clearance_m: 0.1, ..HopperLimits::with_speeds(10.0, 10.0) }).unwrap();
        // The slice continues behind the goal, so that flights that go too far still have ground.
        let scene = Self::of_dem(dem, [(12.0, 84.0), (114.0, 50.0)], hopper, friction(0.9), 3.711);
        Self { ends_m: (0.0, 82.0), ..scene }
    }

    pub(crate) fn planned(&self) -> Planned<'_> {
        let test = HopTest::new(self.chain.clone());
        let station = |x_m| self.chain.geometry().station(x_m).unwrap();
        let (start, goal) = (station(self.ends_m.0), station(self.ends_m.1));
        let answer = search(&test, start, goal, &self.options, &()).unwrap();
        let Outcome::Path { legs, .. } = answer.outcome else { panic!("no path: {:?}", answer.outcome) };
        let path = generate(&test, &legs, self.options.takeoff, Split::FullReach).unwrap();
        let nodes = NodeSet::new(&self.chain, start, goal, answer.spacing).unwrap();
        let to_go = Arc::new(CostToGo::of(&test, nodes, &self.options, &()).unwrap());
        Planned { scene: self, test, path, to_go, start, goal }
    }
}

impl Planned<'_> {
    /// The mission over the DEM if the scene has one, else along the chain; with replanning.
    pub(crate) fn mission(&self) -> Mission {
        self.without_replanning(self.test.clone(), self.path.clone()).with_replanning(self.test.clone(), Arc::clone(&self.to_go))
    }

    /// The mission along the chain, even if the scene has a DEM.
    pub(crate) fn chain_mission(&self) -> Mission {
        Mission::along_chain(self.test.clone(), self.path.clone(), self.start, self.goal)
            .with_replanning(self.test.clone(), Arc::clone(&self.to_go))
    }

    /// The mission with another path, or with the hopper of another hop test.
    pub(crate) fn without_replanning(&self, test: HopTest, path: HopPath) -> Mission {
        match &self.scene.dem {
            None => Mission::along_chain(test, path, self.start, self.goal),
            Some(dem) => {
                let chain = test.chain();
                self.over_dem(dem.clone(), Overlays::default(), path, (chain.hopper(), chain.surface()))
            }
        }
    }

    /// The mission over another DEM with overlays.
    pub(crate) fn over_dem(
        &self,
        dem: Dem,
        overlays: Overlays,
        path: HopPath,
        (hopper, surface): (&Hopper, &SurfaceProperties),
    ) -> Mission {
        let ground = DemGround::new(OverlaidDem::new(dem, overlays), hopper, self.test.chain().gravity(), surface);
        let [start, goal] = [self.start, self.goal].map(|station| self.test.chain().contact_point(&station));
        Mission::over_dem(ground, path, start, goal)
    }

    pub(crate) fn simulation(&self, uncertainty: Uncertainty) -> Simulation {
        Simulation::new(&self.mission(), uncertainty).unwrap()
    }

    pub(crate) fn run(&self, uncertainty: Uncertainty, options: &TrialOptions) -> Summary {
        self.simulation(uncertainty).run(options, &mut (), &()).unwrap()
    }
}

/// Each error alone, large enough to matter in these scenes.
pub(crate) fn each_error(on_a_map: bool) -> Vec<(&'static str, Uncertainty)> {
    let degrees = Angle::from_degrees;
    let mut errors = vec![
        ("speed", Uncertainty { takeoff_speed_sigma_m_s: 0.3, ..Uncertainty::NONE }),
        ("speed fraction", Uncertainty { takeoff_speed_sigma_fraction: 0.05, ..Uncertainty::NONE }),
        ("angle", Uncertainty { takeoff_angle_sigma: degrees(4.0), ..Uncertainty::NONE }),
        ("position", Uncertainty { position_sigma_m: 2.0, ..Uncertainty::NONE }),
        ("drift along", Uncertainty { drift_along_sigma_m: 1.0, ..Uncertainty::NONE }),
        ("drift across", Uncertainty { drift_across_sigma_m: 1.0, ..Uncertainty::NONE }),
        ("friction", Uncertainty { friction_sigma: 0.3, ..Uncertainty::NONE }),
        ("height", Uncertainty { height_sigma_m: 0.5, height_correlation_m: 4.0, ..Uncertainty::NONE }),
    ];
    if on_a_map {
        errors.push(("heading", Uncertainty { heading_sigma: degrees(4.0), ..Uncertainty::NONE }));
    }
    errors
}
