use chta::{ballistics::HopTest, graph::proof::*, graph::*, scenario::*};
use std::time::Instant;
fn main() {
    for name in std::env::args().skip(1) {
        let text = std::fs::read_to_string(&name).unwrap();
        let scenario = Scenario::new(Entries::from_toml(&text)).unwrap();
        let base = std::path::Path::new(&name).parent().unwrap().to_path_buf();
        let p = prepare(&scenario, scenario.terrain.as_ref().unwrap(), &base).unwrap();
        let test = HopTest::new(&p.chain, &scenario.hopper, scenario.body.gravity_m_s2);
        let (s, g) = (p.start.unwrap(), p.goal.unwrap());
        let t = Instant::now();
        let b = bounds(
            &test,
            s,
            g,
            &BoundsOptions {
                search: SearchOptions { spacing: None, ..scenario.search.clone() },
                explain: false,
                ..Default::default()
            },
            &mut |x| println!("   {:?} {:?}", t.elapsed(), x),
        )
        .unwrap();
        println!(
            "{name}: segments {} lower {:?} upper {:?} {:?} {:?}",
            p.chain.segments().len(),
            b.lower,
            b.upper(),
            b.summary,
            t.elapsed()
        );
    }
}
