//! A DEM with its overlays: friction by position, keep-out zones without take-offs and landings, and layers with conditions.

use std::sync::Arc;

use super::{Dem, FrictionRaster, KeepOut, MapLayers, Profile, TerrainError, slice};
use crate::{quantity::MapPoint, world::FrictionCone};

/// The overlays of a terrain: a friction raster, keep-out zones and layers; any may be absent.
#[derive(Clone, Debug, Default)]
pub struct Overlays {
    friction: Option<FrictionRaster>,
    keep_out: Option<KeepOut>,
    keep_in: Option<KeepOut>,
    layers: MapLayers,
}

/// Which overlays have an effect on a profile.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OverlayEffect {
    /// The raster gives the friction of a part of the profile.
    pub friction: bool,
    /// A part of the profile lies in a keep-out zone.
    pub keep_out: bool,
    /// A part of the profile lies outside the keep-in zones.
    pub keep_in: bool,
}

impl Overlays {
    /// The overlays from a friction raster and keep-out zones.
    pub fn new(friction: Option<FrictionRaster>, keep_out: Option<KeepOut>) -> Self {
        Self { friction, keep_out, ..Self::default() }
    }

    /// The same with keep-in zones, of [`read_keep_in`](super::read_keep_in).
    #[must_use]
    pub fn with_keep_in(self, keep_in: Option<KeepOut>) -> Self {
        Self { keep_in, ..self }
    }

    /// The same with layers.
    #[must_use]
    pub fn with_layers(self, layers: MapLayers) -> Self {
        Self { layers, ..self }
    }

    /// The same overlays, of whose friction a share counts.
    pub(crate) fn with_friction_share(&self, share: f64) -> Self {
        Self { friction: self.friction.as_ref().map(|raster| raster.with_share(share)), ..self.clone() }
    }

    /// Whether nothing is laid over the terrain.
    pub fn are_none(&self) -> bool {
        self.friction.is_none() && self.keep_out.is_none() && self.keep_in.is_none() && self.layers.is_empty()
    }

    /// The friction raster.
    pub const fn friction(&self) -> Option<&FrictionRaster> {
        self.friction.as_ref()
    }

    /// The keep-out zones.
    pub const fn keep_out(&self) -> Option<&KeepOut> {
        self.keep_out.as_ref()
    }

    /// The keep-in zones.
    pub const fn keep_in(&self) -> Option<&KeepOut> {
        self.keep_in.as_ref()
    }

    /// All zones, of both kinds.
    pub fn zones(&self) -> impl Iterator<Item = &KeepOut> {
        self.keep_out.iter().chain(&self.keep_in)
    }

    /// The same zones alone.
    pub(crate) fn zones_alone(&self) -> Self {
        Self { keep_out: self.keep_out.clone(), keep_in: self.keep_in.clone(), ..Self::default() }
    }

    /// The layers.
    pub const fn layers(&self) -> &MapLayers {
        &self.layers
    }

    /// Adds friction raster and zones to a profile: friction and zones of its facets, with additional points where borders cross it.
    ///
    /// `constant` is the friction where the raster has no data.
    ///
    /// # Errors
    /// [`TerrainError::Overlay`] if a mask does not cover the profile, or a part of the profile has no friction.
    pub fn lay(&self, profile: &mut Profile, constant: Option<FrictionCone>) -> Result<OverlayEffect, TerrainError> {
        let mut effect = OverlayEffect::default();
        if let Some(raster) = &self.friction {
            effect.friction = raster.lay(profile, constant)?;
        }
        if let Some(zones) = &self.keep_out {
            effect.keep_out = zones.mark(profile)?;
        }
        if let Some(zones) = &self.keep_in {
            effect.keep_in = zones.mark(profile)?;
        }
        Ok(effect)
    }

    /// The friction of the raster at a position; `None` without a raster and where it has no data.
    pub fn friction_at(&self, at: MapPoint) -> Option<FrictionCone> {
        self.friction.as_ref().and_then(|raster| raster.at(at))
    }

    /// Whether a position lies in a keep-out zone or outside the keep-in zones.
    pub fn keeps_out(&self, at: MapPoint) -> bool {
        self.zones().any(|zones| zones.keeps_out(at))
    }
}

/// A DEM and its overlays as one value. A clone shares both.
///
/// # Examples
/// ```
/// use chta::{quantity::MapPoint, terrain::{Dem, GeoReference, OverlaidDem, Overlays}};
/// let plain = Dem::new(2, 2, vec![5.0; 4], GeoReference::local(MapPoint::new(0.0, 1.0), 1.0, 1.0)?)?;
/// let terrain = OverlaidDem::new(plain, Overlays::default());
/// let profile = terrain.slice(MapPoint::new(0.0, 0.0), MapPoint::new(1.0, 0.0), None)?;
/// assert_eq!(profile.length_m(), 1.0);
/// # Ok::<(), chta::terrain::TerrainError>(())
/// ```
#[derive(Clone, Debug)]
pub struct OverlaidDem {
    dem: Arc<Dem>,
    overlays: Arc<Overlays>,
}

impl OverlaidDem {
    /// A DEM with overlays.
    pub fn new(dem: impl Into<Arc<Dem>>, overlays: impl Into<Arc<Overlays>>) -> Self {
        Self { dem: dem.into(), overlays: overlays.into() }
    }

    /// The DEM.
    pub fn dem(&self) -> &Dem {
        &self.dem
    }

    /// The DEM, as a shared pointer.
    pub fn shared_dem(&self) -> Arc<Dem> {
        Arc::clone(&self.dem)
    }

    /// The overlays.
    pub fn overlays(&self) -> &Overlays {
        &self.overlays
    }

    /// The slice from one map point to another with overlays; `constant` is the friction where the raster has no data.
    ///
    /// # Errors
    /// As [`slice`](super::slice()) and [`Overlays::lay`].
    pub fn slice(&self, from: MapPoint, to: MapPoint, constant: Option<FrictionCone>) -> Result<Profile, TerrainError> {
        let mut profile = slice(&self.dem, from, to)?;
        self.overlays.lay(&mut profile, constant)?;
        Ok(profile)
    }
}
