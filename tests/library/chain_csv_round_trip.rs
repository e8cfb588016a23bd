//! Chains of every kind are written to CSV and read back the same, bit by bit.

use chta::{
    chain::{
        ContactRule, GroundForm, LineConstraints, PolygonalChain, SegmentGround,
        csv::{CHAIN_COLUMNS, ChainWriteError, read_chain_csv, read_chain_csv_file, write_chain_csv},
    },
    quantity::{Angle, AngleInterval, ChainPoint, MapPoint, SegmentId},
    world::FrictionCone,
};
use proptest::{collection::vec, prelude::*, sample::select};

fn written(chain: &PolygonalChain) -> Result<String, ChainWriteError> {
    let mut bytes = Vec::new();
    write_chain_csv(chain, &mut bytes, &["first\nsecond".to_owned(), String::new()])?;
    Ok(String::from_utf8(bytes).unwrap_or_else(|error| panic!("no UTF-8: {error}")))
}

/// Numbers that are difficult to print and parse.
fn extreme_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        select(
            &[
                0.0,
                -0.0,
                0.1,
                1.0 / 3.0,
                1e-5,
                9.999_999e-6,
                1e16,
                1e300,
                f64::MIN_POSITIVE,
                5e-324,
                f64::EPSILON,
                123_456_789.123_456_7
            ][..]
        ),
        -1e3..1e3_f64,
        any::<f64>().prop_filter("finite", |x| x.abs() < 1e290),
    ]
}

/// Angles as typed (degrees) and as derived (radians), up to 270 degrees.
fn extreme_angle() -> impl Strategy<Value = Angle> {
    prop_oneof![
        (-270..=270_i32).prop_map(|degrees| Angle::from_degrees(f64::from(degrees))),
        (-4.71..4.71_f64).prop_map(Angle::from_radians),
        any::<f64>().prop_map(Angle::from_slope).prop_filter("a number", |a| a.radians().abs() > 1e-268),
    ]
}

fn cone() -> impl Strategy<Value = ContactRule> {
    let speed = prop_oneof![Just(0.0), 0.0..20.0_f64, extreme_number().prop_map(f64::abs)];
    (extreme_angle(), extreme_angle(), speed).prop_map(|(a, b, speed)| {
        let (min, max) = if a <= b { (a, b) } else { (b, a) };
        ContactRule::new(AngleInterval { min, max }, speed)
    })
}

fn limits() -> impl Strategy<Value = LineConstraints> {
    (cone(), cone()).prop_map(|(takeoff, landing)| LineConstraints { takeoff, landing })
}

/// The grounds of `count` segments, all in one form.
fn grounds(count: usize) -> BoxedStrategy<Vec<SegmentGround>> {
    let surface = (any::<bool>(), any::<bool>()).prop_flat_map(move |(friction, cross)| {
        let angle = prop_oneof![Just(0.0), 0.0..1.57_f64, Just(std::f64::consts::FRAC_PI_2)];
        vec((extreme_number(), angle), count).prop_map(move |all| {
            let form = |(mu, chi): (f64, f64)| GroundForm::Surface {
                friction: if friction { FrictionCone::new(mu.abs()).ok() } else { None },
                cross_slope: Angle::from_radians(if cross { chi } else { 0.0 }),
            };
            all.into_iter().map(form).collect::<Vec<_>>()
        })
    });
    let explicit = select(&[(true, true), (true, false), (false, true)][..]).prop_flat_map(move |(forward, reverse)| {
        vec((limits(), limits()), count).prop_map(move |all| {
            let form = |(f, r): (LineConstraints, LineConstraints)| GroundForm::Explicit {
                forward: forward.then_some(f),
                reverse: reverse.then_some(r),
            };
            all.into_iter().map(form).collect::<Vec<_>>()
        })
    });
    let keep_out = prop_oneof![vec(any::<bool>(), count), Just(vec![false; count])];
    (prop_oneof![surface, explicit], keep_out)
        .prop_map(|(forms, keep_out)| {
            forms.into_iter().zip(keep_out).map(|(form, keep_out)| SegmentGround { form, keep_out }).collect()
        })
        .boxed()
}

fn chains() -> impl Strategy<Value = PolygonalChain> {
    // No body has heights of 1e9 m: the reader refuses them as marks of missing data.
    let height = extreme_number().prop_map(|z| if z.abs() < 1e9 { z } else { z / f64::MAX });
    let vertices = vec((extreme_number(), height), 2..12).prop_map(|mut points| {
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points.dedup_by(|a, b| a.0 == b.0);
        points.into_iter().map(|(x, z)| ChainPoint::new(x, z)).collect::<Vec<_>>()
    });
    let of = |vertices: Vec<ChainPoint>| {
        let count = vertices.len();
        let map = proptest::option::of(vec((extreme_number(), extreme_number()), count));
        (Just(vertices), grounds(count.saturating_sub(1)), map)
    };
    vertices.prop_flat_map(of).prop_filter_map("a slope overflows", |(vertices, grounds, map)| {
        let map = map.map(|points| points.into_iter().map(|(x, y)| MapPoint::new(x, y)).collect());
        PolygonalChain::new(vertices, grounds, map).ok()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn chains_read_back_as_they_were(chain in chains()) {
        let text = written(&chain).unwrap();
        let read = read_chain_csv(text.as_bytes()).map_err(|problems| TestCaseError::fail(format!("{problems}\n{text}")))?;
        prop_assert_eq!(&read.chain, &chain, "{}", text);
        prop_assert_eq!(written(&read.chain).unwrap(), text);
    }
}

fn one_segment(grounds: Vec<SegmentGround>) -> PolygonalChain {
    let vertices = [0.0, 1.0, 2.0, 3.0].into_iter().take(grounds.len() + 1).map(|x| ChainPoint::new(x, 0.0)).collect();
    PolygonalChain::new(vertices, grounds, None).unwrap_or_else(|invalid| panic!("{invalid}"))
}

fn explicit(forward: Option<LineConstraints>, reverse: Option<LineConstraints>) -> SegmentGround {
    SegmentGround { form: GroundForm::Explicit { forward, reverse }, keep_out: false }
}

fn rule(min_deg: f64, max_deg: f64, speed_m_s: f64) -> ContactRule {
    ContactRule::new(AngleInterval::from_degrees(min_deg, max_deg), speed_m_s)
}

#[test]
fn written_files_have_the_documented_form() {
    let limits = LineConstraints { takeoff: rule(63.5, 93.5, 10.0), landing: rule(-93.5, -60.0, 0.0) };
    assert_eq!(
        written(&one_segment(vec![explicit(Some(limits), None)])).unwrap(),
        "# first\n# second\n#\nx_m,z_m,takeoff_min_deg,takeoff_max_deg,takeoff_speed_max_m_s,landing_min_deg,landing_max_deg,landing_speed_max_m_s\n\
         0,0,63.5,93.5,10,-93.5,-60,0\n1,0,,,,,,\n"
    );
    let surface = |mu, chi_deg, keep_out| SegmentGround {
        form: GroundForm::Surface { friction: FrictionCone::new(mu).ok(), cross_slope: Angle::from_degrees(chi_deg) },
        keep_out,
    };
    assert_eq!(
        written(&one_segment(vec![surface(0.6, 0.0, true), surface(0.7, 2.5, false)])).unwrap(),
        "# first\n# second\n#\nx_m,z_m,friction_coefficient,cross_slope_deg,keep_out\n0,0,0.6,0,1\n1,0,0.7,2.5,0\n2,0,,,\n"
    );
    assert_eq!(written(&one_segment(vec![SegmentGround::BARE])).unwrap(), "# first\n# second\n#\nx_m,z_m\n0,0\n1,0\n");
}

#[test]
fn columns_in_any_order_and_notation_are_read() {
    let plain = b"x_m,z_m,friction_coefficient,keep_out,map_x_m,map_y_m\n0,0,0.6,1,5,6\n1,2,0.5,0,7,8\n2,2,,,9,10\n";
    let odd = "\u{feff}# dressed\r\n\"map_y_m\", keep_out ,z_m,note,x_m,map_x_m,friction_coefficient\r\n\r\n\"6\",1.0, 0 ,\"a,\r\n\"\"b\",0,5,+.6\r\n\
               8,0,2e0,,1,7,0.50\r\n#\r\n10,,2,,2.,9,";
    assert_eq!(read_chain_csv(plain).unwrap().chain, read_chain_csv(odd.as_bytes()).unwrap().chain);
    assert_eq!(read_chain_csv(plain).unwrap().warnings, [""; 0]);
}

#[test]
fn what_a_file_cannot_state_is_speed_zero_or_refused() {
    let good = LineConstraints { takeoff: rule(60.0, 90.0, 10.0), landing: rule(-90.0, -60.0, 10.0) };
    // A direction that one segment leaves out, and a set with crossed ends: not allowed there.
    let crossed = LineConstraints { takeoff: rule(90.0, 60.0, 10.0), ..good };
    let chain = one_segment(vec![explicit(Some(good), Some(good)), explicit(Some(crossed), None)]);
    let text = written(&chain).unwrap();
    assert!(text.contains("\n1,0,60,90,0,-90,-60,10,0,0,0,0,0,0\n"), "{text}");
    let read = read_chain_csv(text.as_bytes()).unwrap().chain;
    assert_eq!(read.grounds()[0], chain.grounds()[0]);
    // Where nothing is allowed, that is kept, and the chain does not take constraints from the scenario.
    let nothing = read_chain_csv(written(&one_segment(vec![explicit(None, None)])).unwrap().as_bytes()).unwrap().chain;
    let GroundForm::Explicit { forward: Some(forward), reverse: None } = nothing.grounds()[0].form else { panic!("{nothing:?}") };
    assert_eq!((forward.takeoff.speed_max_m_s(), forward.landing.speed_max_m_s()), (0.0, 0.0));

    let refusal = |grounds| written(&one_segment(grounds)).unwrap_err();
    let unlimited = LineConstraints { takeoff: rule(60.0, 90.0, f64::INFINITY), ..good };
    let message = refusal(vec![explicit(Some(good), None), explicit(Some(unlimited), None)]).to_string();
    assert!(message.contains("segment 2 has the takeoff_speed_max_m_s inf, expected a finite speed"), "{message}");
    let beyond = LineConstraints { landing: rule(-300.0, 0.0, 1.0), ..good };
    assert!(matches!(
        refusal(vec![explicit(None, Some(beyond))]),
        ChainWriteError::Unwritable { column: "reverse_landing_min_deg", segment: SegmentId(0), .. }
    ));
    assert!(matches!(refusal(vec![SegmentGround::BARE, explicit(Some(good), None)]), ChainWriteError::MixedForms(SegmentId(1))));
    let rough = SegmentGround {
        form: GroundForm::Surface { friction: FrictionCone::new(0.6).ok(), cross_slope: Angle::default() },
        keep_out: false,
    };
    assert!(matches!(refusal(vec![rough, rough, SegmentGround::BARE]), ChainWriteError::MixedFriction(SegmentId(2))));
}

#[test]
fn files_on_disk_are_named_in_errors() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("chain.csv");
    let message = read_chain_csv_file(&path).unwrap_err().to_string();
    assert!(message.contains("chain.csv: cannot be read"), "{message}");
    std::fs::write(&path, "x_m,z_m\n0,a\n0,b\n").unwrap();
    let message = read_chain_csv_file(&path).unwrap_err().to_string();
    assert_eq!(message.lines().filter(|line| line.contains("chain.csv: line ")).count(), 3, "{message}");
    std::fs::write(&path, "x_m,z_m\n0,1\n2,3\n").unwrap();
    assert_eq!(read_chain_csv_file(&path).unwrap().chain.slopes(), [1.0]);
}

#[test]
fn every_column_is_explained() {
    for column in &CHAIN_COLUMNS {
        assert!(!column.help.is_empty() && !column.help.contains('\n'), "{} has no help of one line", column.name);
    }
}
