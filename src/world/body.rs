//! Known bodies, with gravity, radius and the source of both.

use super::Gravity;

/// A body to hop on, with constant surface gravity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Lower-case name.
    pub name: &'static str,
    /// Surface gravity, with the mean radius.
    pub gravity: Gravity,
    /// Mean radius, m.
    pub radius_m: f64,
    /// The sources of gravity and radius.
    pub source: &'static str,
}

impl Body {
    /// The known body of this name, in any letter case.
    ///
    /// ```
    /// use chta::world::Body;
    /// assert_eq!(Body::named("Mars").unwrap().gravity.m_s2(), 3.711);
    /// assert!(Body::named("Krypton").is_none());
    /// ```
    pub fn named(name: &str) -> Option<&'static Self> {
        KNOWN_BODIES.iter().find(|body| body.name.eq_ignore_ascii_case(name))
    }

    /// Escape speed at the surface, `sqrt(2 g R)`, m/s.
    ///
    /// ```
    /// use chta::world::Body;
    /// // The Moon: sqrt(2 x 1.6242 x 1 737 400) = 2 376 m/s
    /// assert!((Body::named("moon").unwrap().escape_speed_m_s() - 2376.0).abs() < 1.0);
    /// ```
    pub fn escape_speed_m_s(&self) -> f64 {
        (2.0 * self.gravity.m_s2() * self.radius_m).sqrt()
    }

    /// A body whose gravity follows from the gravitational parameter and the mean radius, `g = GM / R^2`.
    const fn from_gm(name: &'static str, gm_m3_s2: f64, radius_m: f64, source: &'static str) -> Self {
        Self { name, gravity: Gravity::known(gm_m3_s2 / (radius_m * radius_m), radius_m), radius_m, source }
    }

    /// A body whose gravity is taken as published.
    const fn published(name: &'static str, gravity_m_s2: f64, radius_m: f64, source: &'static str) -> Self {
        Self { name, gravity: Gravity::known(gravity_m_s2, radius_m), radius_m, source }
    }
}

/// Every body that the program knows by name. The gravities ignore rotation and the irregular shapes of small bodies.
pub const KNOWN_BODIES: [Body; 15] = [
    Body::from_gm("moon", 4.902_800_066e12, 1_737_400.0, "GM: GRAIL, JPL DE430 (Folkner et al. 2014); radius: IAU WGCCRE 2015"),
    Body::published(
        "mars",
        3.711,
        3_389_500.0,
        "gravity at the equator: NASA Solar System Exploration, and the CHTA paper, section V-B; radius: IAU WGCCRE 2015",
    ),
    Body::from_gm("mercury", 2.203_187e13, 2_439_400.0, "GM: MESSENGER (Konopliv et al. 2020); radius: IAU WGCCRE 2015"),
    Body::from_gm("phobos", 7.072e5, 11_080.0, "GM: Mars Express (Paetzold et al. 2014); radius: IAU WGCCRE 2015"),
    Body::from_gm("deimos", 9.8e4, 6_200.0, "GM: Jacobson 2010; radius: IAU WGCCRE 2015"),
    Body::from_gm("ceres", 6.262_84e10, 469_700.0, "GM: Dawn (Konopliv et al. 2018); radius: Park et al. 2016"),
    Body::from_gm("vesta", 1.728_828e10, 262_700.0, "GM: Dawn (Konopliv et al. 2014); radius: Russell et al. 2012"),
    Body::from_gm("europa", 3.202_739e12, 1_560_800.0, "GM: Galileo (Anderson et al. 1998); radius: IAU WGCCRE 2015"),
    Body::from_gm("enceladus", 7.210_4e9, 252_100.0, "GM: Cassini (Jacobson et al. 2006); radius: IAU WGCCRE 2015"),
    Body::from_gm("titan", 8.978_138e12, 2_574_730.0, "GM: Cassini (Jacobson et al. 2006); radius: Zebker et al. 2009"),
    Body::from_gm("bennu", 4.892, 245.03, "GM: OSIRIS-REx (Scheeres et al. 2019); radius: Lauretta et al. 2019"),
    Body::from_gm("ryugu", 30.0, 448.0, "GM and radius: Hayabusa2 (Watanabe et al. 2019)"),
    Body::from_gm("eros", 4.463e5, 8_420.0, "GM: NEAR Shoemaker (Miller et al. 2002); radius: IAU WGCCRE 2015"),
    Body::from_gm("67p", 666.2, 1_650.0, "GM: Rosetta (Paetzold et al. 2016); radius: of equal volume, Jorda et al. 2016"),
    Body::published("earth", 9.806_65, 6_371_008.4, "standard gravity: CGPM 1901; radius: IAU WGCCRE 2015"),
];

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares with surface gravities of fact sheets (NSSDCA, JPL SSD), to the few digits printed there.
    #[test]
    fn gravities_agree_with_printed_fact_sheets() {
        let printed = [
            ("moon", 1.62),
            ("mars", 3.71),
            ("mercury", 3.70),
            ("phobos", 0.0057),
            ("deimos", 0.0025),
            ("ceres", 0.284),
            ("vesta", 0.25),
            ("europa", 1.315),
            ("enceladus", 0.113),
            ("titan", 1.354),
            ("bennu", 8.1e-5),
            ("ryugu", 1.5e-4),
            ("eros", 6.3e-3),
            ("67p", 2.45e-4),
            ("earth", 9.81),
        ];
        assert_eq!(printed.len(), KNOWN_BODIES.len(), "every body needs a printed figure");
        for (name, gravity) in printed {
            let body = Body::named(name).unwrap();
            assert!((body.gravity.m_s2() / gravity - 1.0).abs() < 0.02, "{name}: {} against {gravity}", body.gravity.m_s2());
        }
    }

    #[test]
    fn every_body_names_its_source() {
        for body in &KNOWN_BODIES {
            assert!(body.source.contains("radius"), "{}: no source for the radius", body.name);
            assert!(Gravity::new(body.gravity.m_s2()).is_ok(), "{}", body.name);
            assert!(body.radius_m > 100.0 && body.escape_speed_m_s() > 0.0, "{}", body.name);
        }
    }
}
