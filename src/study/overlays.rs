//! The overlays of a scenario on its terrain: friction, zones and layers, read once.

use std::{path::Path, sync::Arc};

use super::pipeline::PipelineError;
use crate::{
    chain::PolygonalChain,
    ground::DemGround,
    scenario::{Route, Scenario},
    terrain::{
        self, CoordinateSystem, Dem, FrictionRaster, KeepOut, Layer, MapBounds, MapLayers, OverlaidDem, OverlayEffect, Profile,
        TerrainError, read_friction_raster, read_keep_in, read_keep_out, read_layer,
    },
    world::FrictionCone,
};

/// The overlays of a scenario on its terrain, read once, with the friction for ground without raster data.
#[derive(Clone, Debug)]
pub struct Overlays {
    constant: Option<FrictionCone>,
    overlays: Arc<terrain::Overlays>,
}

impl Overlays {
    /// Reads the overlay files of a scenario, for a terrain of the given map and extent.
    ///
    /// `base` is the folder that the scenario's paths start from.
    ///
    /// # Errors
    /// [`TerrainError::Overlay`].
    pub fn read(
        scenario: &Scenario,
        base: &Path,
        coordinates: Option<&CoordinateSystem>,
        bounds: MapBounds,
    ) -> Result<Self, TerrainError> {
        let raster = scenario.friction_raster.as_deref().map(|path| read_friction_raster(&base.join(path), coordinates));
        let keep_out = scenario.keep_out.as_deref().map(|path| read_keep_out(&base.join(path), coordinates, bounds));
        let keep_in = scenario.keep_in.as_deref().map(|path| read_keep_in(&base.join(path), coordinates, bounds));
        let layers = scenario.layers.iter().map(|layer| read_layer(&base.join(&layer.raster), layer.rule, coordinates));
        let layers = MapLayers::new(layers.collect::<Result<_, _>>()?);
        let overlays = terrain::Overlays::new(raster.transpose()?, keep_out.transpose()?);
        let overlays = overlays.with_keep_in(keep_in.transpose()?).with_layers(layers);
        Ok(Self { constant: friction(scenario), overlays: Arc::new(overlays) })
    }

    /// The same overlays with the rules that a scenario gives its layers, whose rasters are those that were read.
    ///
    /// # Errors
    /// [`TerrainError::Overlay`], for what a rule asks of the values.
    pub(super) fn under(&self, scenario: &Scenario) -> Result<Self, TerrainError> {
        let read = self.overlays.layers();
        let of_rule = |layer: &Layer| {
            let keys = scenario.layers.iter().find(|keys| keys.rule.name == layer.rule().name);
            keys.map_or_else(|| Ok(layer.clone()), |keys| layer.under(keys.rule))
        };
        let layers = MapLayers::new(read.iter().map(of_rule).collect::<Result<_, _>>()?);
        Ok(Self { constant: self.constant, overlays: Arc::new(self.overlays.as_ref().clone().with_layers(layers)) })
    }

    /// Whether its layers have the rules that a scenario gives them.
    pub(super) fn has_rules_of(&self, scenario: &Scenario) -> bool {
        let is_same =
            |layer: &Layer| scenario.layers.iter().all(|keys| keys.rule.name != layer.rule().name || keys.rule == *layer.rule());
        self.overlays.layers().iter().all(is_same)
    }

    /// A whole DEM under these overlays.
    pub(super) fn laid_over(&self, dem: impl Into<Arc<Dem>>) -> OverlaidDem {
        OverlaidDem::new(dem, Arc::clone(&self.overlays))
    }

    /// The ground of a whole DEM under these overlays, for a scenario's hopper, gravity and surface.
    pub fn ground(&self, dem: impl Into<Arc<Dem>>, scenario: &Scenario) -> DemGround {
        DemGround::new(self.laid_over(dem), &scenario.hopper, scenario.body.gravity, &scenario.surface)
    }

    /// The same under the limits that planning may use.
    pub(super) fn planning_ground(&self, dem: Dem, scenario: &Scenario) -> DemGround {
        planned_over(&self.ground(dem, scenario), scenario)
    }

    /// The overlay files of a scenario, relative to its folder.
    pub fn files(scenario: &Scenario) -> impl Iterator<Item = &Path> {
        let zones = [&scenario.friction_raster, &scenario.keep_out, &scenario.keep_in].into_iter().filter_map(Option::as_deref);
        zones.chain(scenario.layers.iter().map(|layer| layer.raster.as_path()))
    }

    /// A warning for each overlay without effect on a DEM of these bounds.
    pub fn without_effect_on_dem(&self, bounds: MapBounds) -> Vec<String> {
        let raster =
            self.overlays.friction().filter(|raster| !raster.covers(bounds)).map(|raster| raster.without_effect("the DEM"));
        let keep_out = self.overlays.zones().filter(|zones| !zones.meets(bounds)).map(|zones| zones.without_effect("the DEM"));
        let layers = self.overlays.layers().iter().filter_map(|layer| layer.without_choice(bounds, "the DEM"));
        self.not_compared().chain(raster).chain(keep_out).chain(layers).collect()
    }

    /// A warning for each overlay whose map could not be compared with the terrain's.
    fn not_compared(&self) -> impl Iterator<Item = String> + '_ {
        let raster = self.overlays.friction().and_then(FrictionRaster::not_compared);
        let layers = self.overlays.layers().iter().filter_map(Layer::not_compared);
        raster.into_iter().chain(self.overlays.zones().filter_map(KeepOut::not_compared)).chain(layers).map(str::to_owned)
    }

    /// A slice of the terrain, leg by leg, as a chain with its friction and its keep-out zones, and a warning for each overlay
    /// without effect on it.
    ///
    /// # Errors
    /// [`TerrainError::Overlay`] if a raster ends before the slice does.
    pub fn chain_with_warnings(&self, legs: Vec<Profile>) -> Result<(PolygonalChain, Vec<String>), PipelineError> {
        self.laid(legs, self.constant)
    }

    /// The same with this friction for ground without raster data.
    pub(super) fn laid(
        &self,
        mut legs: Vec<Profile>,
        constant: Option<FrictionCone>,
    ) -> Result<(PolygonalChain, Vec<String>), PipelineError> {
        let mut effect = OverlayEffect::default();
        for leg in &mut legs {
            let of_leg = self.overlays.lay(leg, constant)?;
            effect.friction |= of_leg.friction;
            effect.keep_out |= of_leg.keep_out;
            effect.keep_in |= of_leg.keep_in;
        }
        let raster = self.overlays.friction().filter(|_| !effect.friction).map(|raster| raster.without_effect("the transect"));
        let keep_out = self.overlays.keep_out().filter(|_| !effect.keep_out).map(|zones| zones.without_effect("the transect"));
        let keep_in = self.overlays.keep_in().filter(|_| !effect.keep_in).map(|zones| zones.without_bounds("the transect"));
        let raster_alone = legs.iter().flat_map(|leg| &leg.facets).all(|facet| facet.friction.is_some());
        let replaced = (constant.is_some() && effect.friction && raster_alone).then(|| {
            "surface.friction_coefficient has no effect: the friction raster has data under the whole transect; leave it out, or correct \
             the raster"
                .to_owned()
        });
        let warnings = self.not_compared().chain(raster).chain(keep_out).chain(keep_in).chain(replaced).collect();
        Ok((PolygonalChain::from_legs(&legs, constant)?.with_layers(self.overlays.layers()), warnings))
    }
}

/// The ground of a DEM under the limits that planning may use, of a scenario with the whole limits; the same where those are not derated.
pub(super) fn planned_over(ground: &DemGround, scenario: &Scenario) -> DemGround {
    let Some(derated) = scenario.derated() else { return ground.clone() };
    let overlays = ground.terrain().overlays().with_friction_share(scenario.derating.friction);
    let terrain = OverlaidDem::new(ground.terrain().shared_dem(), overlays);
    // As the ground itself: over a free route any command.
    let hopper = if scenario.route == Route::Free { derated.hopper.with_any_command() } else { derated.hopper };
    DemGround::new(terrain, &hopper, derated.body.gravity, &derated.surface)
}

/// The friction of a scenario for the whole ground.
pub fn friction(scenario: &Scenario) -> Option<FrictionCone> {
    scenario.surface.constant_friction()
}
