//! Limits in words, for readers of pictures who do not know the keys of answers.

use crate::world::Limit;

/// A limit in words, such as `take-off speed`; the name of a layer with `layer`.
pub(super) fn words(limit: Limit) -> String {
    let words = match limit {
        Limit::Direction => "no contact stated",
        Limit::KeepOut => "keep-out zone",
        Limit::RestSlope => "slope to rest on",
        Limit::FootprintSlope => "slope under the footprint",
        Limit::Roughness => "roughness",
        Limit::Bend => "bend of the line",
        Limit::TakeoffCone => "take-off cone",
        Limit::LandingCone => "landing cone",
        Limit::TakeoffSpeed => "take-off speed",
        Limit::LandingSpeed => "landing speed",
        Limit::Touchdown => "touchdown",
        Limit::LineOfSight => "line of sight",
        Limit::Terrain => "terrain",
        Limit::MechanicalAngle => "range of angles",
        Limit::ApexHeight => "apex height",
        Limit::FlightTime => "flight time",
        Limit::TakeoffSpeedMin => "least take-off speed",
        Limit::TakeoffSpeedLevels => "take-off speed levels",
        Limit::TakeoffAngleStep => "steps of angle",
        Limit::TakeoffSpeedStep => "steps of speed",
        Limit::HeadingStep => "steps of heading",
        Limit::Stroke => "stroke of the legs",
        Limit::Force => "force of a foot",
        Limit::Spin => "spin",
        Limit::Layer(_) => return limit.name().replace(':', " "),
    };
    words.to_owned()
}

/// What stops a hopper where a limit refuses, as the end of a sentence.
pub(super) fn obstacle(limit: Limit) -> String {
    let words = match limit {
        Limit::Direction => "no contact is stated for the ground there",
        Limit::KeepOut => "the place lies in a keep-out zone",
        Limit::RestSlope => "the ground there is steeper than the hopper can rest on",
        Limit::FootprintSlope => "the ground under the footprint is too steep, or not known",
        Limit::Roughness => "the ground there is rougher than the hopper can stand on",
        Limit::Bend => "a hop cannot turn at a bend of the line",
        Limit::TakeoffCone => "the hop would leave the ground too flat for its grip",
        Limit::LandingCone => "the hop would meet the ground too flat for its grip",
        Limit::TakeoffSpeed => "the hop would need a faster take-off than the machine has",
        Limit::LandingSpeed => "the hop would land faster than the machine bears",
        Limit::Touchdown => "the touchdown straight down would slip or be too fast",
        Limit::LineOfSight | Limit::Terrain => "terrain stands in the way",
        Limit::MechanicalAngle => "the machine cannot take off at the angles that would do",
        Limit::ApexHeight => "the hop would rise higher than allowed",
        Limit::FlightTime => "the hop would fly longer than allowed",
        Limit::TakeoffSpeedMin => "the hop would need a slower take-off than the machine has",
        Limit::TakeoffSpeedLevels => "none of the machine's take-off speeds fits",
        Limit::TakeoffAngleStep | Limit::TakeoffSpeedStep | Limit::HeadingStep => "the machine's steps are too coarse",
        Limit::Stroke => "the legs cannot push in that direction",
        Limit::Force => "a foot would bear too much",
        Limit::Spin => "the push would leave too much spin",
        Limit::Layer(_) => return format!("the {} does not hold", words(limit)),
    };
    words.to_owned()
}

/// What would remove the obstacle.
pub(super) fn remedy(limit: Limit) -> &'static str {
    match limit {
        Limit::Direction | Limit::KeepOut | Limit::Layer(_) => "another route",
        Limit::RestSlope | Limit::FootprintSlope => "a hopper that rests on steeper ground, or another route",
        Limit::Roughness => "a hopper that stands on rougher ground, or another route",
        Limit::Bend => "a bend elsewhere, or a route without one",
        Limit::TakeoffCone | Limit::LandingCone | Limit::Touchdown => "more grip (friction), or another route",
        Limit::TakeoffSpeed => "a greater take-off speed",
        Limit::LandingSpeed => "a greater landing speed",
        Limit::LineOfSight | Limit::Terrain => "higher hops, or another route",
        Limit::MechanicalAngle => "a wider range of take-off angles",
        Limit::ApexHeight => "higher hops",
        Limit::FlightTime => "longer flights",
        Limit::TakeoffSpeedMin => "a smaller least take-off speed",
        Limit::TakeoffSpeedLevels => "more take-off speeds",
        Limit::TakeoffAngleStep | Limit::TakeoffSpeedStep | Limit::HeadingStep => "finer steps",
        Limit::Stroke => "a longer stroke",
        Limit::Force => "a greater force of a foot",
        Limit::Spin => "a greater rate of rotation",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No words of a limit are a key.
    #[test]
    fn every_limit_has_words() {
        for limit in Limit::ALL {
            let all = [words(limit), obstacle(limit), remedy(limit).to_owned()];
            assert!(all.iter().all(|text| !text.is_empty() && !text.contains("takeoff") && !text.contains('_')), "{all:?}");
            assert!(!words(limit).contains('-') || words(limit).contains("take-off") || limit == Limit::KeepOut, "{limit}");
        }
    }
}
