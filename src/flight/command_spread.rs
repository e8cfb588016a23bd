//! How the errors of a command are spread, for a closed form that flies no draws.

use super::{Distribution, MeasuredErrors, Uncertainty};
use crate::quantity::normal_cdf;

/// The errors of take-off speed and angle of a single hop, those that last for a trial included.
///
/// Deviations have their distribution: Gaussian, or even. Of measured errors the means and deviations count, as if they were Gaussian: with
/// rows of several separate groups, the trials that fly the rows themselves decide.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CommandSpread {
    angle: Spread,
    /// Standard deviation of the limits of the angle, rad.
    limits_rad: f64,
    /// As a fraction of the commanded speed.
    fraction: Spread,
    speed_m_s: Spread,
}

/// The spread of one error.
#[derive(Clone, Copy, Debug, Default)]
struct Spread {
    mean: f64,
    /// Standard deviation of what is Gaussian, or taken so.
    gaussian: f64,
    /// Standard deviations of independent errors that are even, the greatest first.
    even: [f64; 2],
}

impl CommandSpread {
    pub(crate) fn of(errors: &Uncertainty) -> Self {
        let spread = |own: f64, bias: f64| match errors.distribution {
            Distribution::Normal => Spread { gaussian: libm::hypot(own, bias), ..Spread::default() },
            Distribution::Uniform => Spread { even: [own.max(bias), own.min(bias)], ..Spread::default() },
        };
        let spread = Self {
            angle: spread(errors.takeoff_angle_sigma.radians(), errors.takeoff_angle_bias_sigma.radians()),
            limits_rad: 0.0,
            fraction: spread(errors.takeoff_speed_sigma_fraction, errors.takeoff_speed_bias_sigma_fraction),
            speed_m_s: spread(errors.takeoff_speed_sigma_m_s, 0.0),
        };
        errors.measured.as_ref().map_or(spread, |measured| spread.with(measured))
    }

    /// With measured errors beside the deviations that they do not replace.
    fn with(self, measured: &MeasuredErrors) -> Self {
        let angle_rad = measured.mean(|row| row.angle_rad);
        let fraction = measured.mean(|row| row.speed_fraction);
        let speed_m_s = measured.mean(|row| row.speed_m_s);
        let square = |deviation: f64| deviation * deviation;
        Self {
            angle: self.angle.and(angle_rad, measured.mean(|row| square(row.angle_rad - angle_rad))),
            limits_rad: self.limits_rad,
            fraction: self.fraction.and(fraction, measured.mean(|row| square(row.speed_fraction - fraction))),
            speed_m_s: self.speed_m_s.and(speed_m_s, measured.mean(|row| square(row.speed_m_s - speed_m_s))),
        }
    }

    /// With an independent Gaussian error of the limits of the angle, rad.
    pub(crate) fn with_error_of_limits(self, sigma_rad: f64) -> Self {
        Self { limits_rad: sigma_rad, ..self }
    }

    /// Standard deviation of the speed about the commanded one, as a fraction of that.
    pub(crate) fn speed_deviation(&self, commanded_m_s: f64) -> f64 {
        self.of_speed(commanded_m_s).deviation() / commanded_m_s
    }

    /// Standard deviation of the angle about the commanded one, rad.
    pub(crate) fn angle_deviation(&self) -> f64 {
        self.angle.deviation()
    }

    /// The probability that the angle is off by no more than this, downwards and upwards.
    pub(crate) fn angle_within(&self, down_rad: f64, up_rad: f64) -> f64 {
        let angle = self.angle.and(0.0, self.limits_rad * self.limits_rad);
        (angle.negated().share_below(down_rad) + angle.share_below(up_rad) - 1.0).max(0.0)
    }

    /// The probability that a hop lands no faster than this, by its commanded take-off speed and its landing speed without errors.
    ///
    /// `v_l^2 = v_t^2 - 2 g Z`: an error of the take-off speed is one of the landing speed, times `v_t / v_l`.
    pub(crate) fn landing_speed_below(&self, takeoff_m_s: f64, landing_m_s: f64, most_m_s: f64) -> f64 {
        self.of_speed(takeoff_m_s).scaled(takeoff_m_s).share_below((most_m_s - landing_m_s) * landing_m_s)
    }

    /// The spread of a commanded take-off speed, m/s.
    fn of_speed(&self, commanded_m_s: f64) -> Spread {
        let fraction = self.fraction.scaled(commanded_m_s);
        let Spread { mean, gaussian, even } = self.speed_m_s;
        let gaussian = libm::hypot(fraction.gaussian, gaussian);
        let [a, b] = fraction.even;
        // Of three errors that are even, the greatest keeps its shape, and the others count as one.
        let c = even[0];
        let even = if c > a { [c, libm::hypot(a, b)] } else { [a, libm::hypot(b, c)] };
        Spread { mean: fraction.mean + mean, gaussian, even }
    }
}

impl Spread {
    fn scaled(self, factor: f64) -> Self {
        let Self { mean, gaussian, even } = self;
        Self { mean: factor * mean, gaussian: factor * gaussian, even: even.map(|sigma| factor * sigma) }
    }

    /// With an independent error of this mean and variance, taken as Gaussian.
    fn and(self, mean: f64, variance: f64) -> Self {
        Self { mean: self.mean + mean, gaussian: libm::hypot(self.gaussian, variance.sqrt()), ..self }
    }

    /// The root of the mean square.
    fn deviation(&self) -> f64 {
        let Self { mean, gaussian, even: [wide, narrow] } = *self;
        [mean, gaussian, wide, narrow].iter().map(|part| part * part).sum::<f64>().sqrt()
    }

    fn negated(self) -> Self {
        Self { mean: -self.mean, ..self }
    }

    /// The probability that the error is at most so large. Without any error it is 1, whatever the room: a plan keeps its limits.
    fn share_below(&self, room: f64) -> f64 {
        let Self { mean, gaussian, even: [wide, narrow] } = *self;
        let beyond = room - mean;
        match (gaussian > 0.0, wide > 0.0) {
            (false, false) => f64::from(u8::from(mean == 0.0 || beyond >= 0.0)),
            (false, true) => Distribution::share_of_two_even(beyond, [wide, narrow]),
            (true, false) => normal_cdf(beyond / gaussian),
            (true, true) => normal_cdf(beyond / libm::hypot(gaussian, libm::hypot(wide, narrow))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        chain::csv::read_measured_csv,
        flight::{Errors, quasi::fixed_draws},
        quantity::Angle,
    };

    /// Rows whose errors are a mean and a deviation times the quantiles of a Gaussian, speeds and angles in different orders.
    fn rows(columns: &str, count: u32, row: impl Fn(f64, f64) -> String) -> MeasuredErrors {
        let quantile = |i: u32| Distribution::Normal.standard_quantile((f64::from(i % count) + 0.5) / f64::from(count));
        let rows = (0..count).map(|i| row(quantile(i), quantile(i * 89))).collect::<Vec<_>>().join("\n");
        let file = read_measured_csv(format!("{columns}\n{rows}\n").as_bytes()).expect("a valid file");
        MeasuredErrors::of(&file)
    }

    /// Against the share of 4 096 fixed draws, by the code that draws errors for flights.
    #[test]
    fn shares_are_those_of_drawn_errors() {
        let degrees = Angle::from_degrees;
        let speed = Uncertainty { takeoff_speed_sigma_fraction: 0.02, takeoff_angle_sigma: degrees(1.0), ..Uncertainty::NONE };
        let lasting =
            Uncertainty { takeoff_speed_bias_sigma_fraction: 0.015, takeoff_angle_bias_sigma: degrees(0.6), ..speed.clone() };
        let three = Uncertainty { takeoff_speed_sigma_m_s: 0.03, ..lasting.clone() };
        let bias_alone =
            Uncertainty { takeoff_speed_bias_sigma_fraction: 0.01, takeoff_angle_bias_sigma: degrees(0.4), ..Uncertainty::NONE };
        let both =
            rows("takeoff_speed_error_fraction,takeoff_angle_error_deg", 256, |a, b| format!("{},{}", 0.01 + 0.02 * a, 0.5 + b));
        let in_m_s =
            rows("takeoff_speed_error_m_s,takeoff_angle_error_deg", 256, |a, b| format!("{},{}", 0.08 * a - 0.02, 0.8 * b));
        let angle_alone = rows("takeoff_angle_error_deg", 256, |_, b| format!("{}", b - 0.3));
        let one = rows("takeoff_speed_error_m_s,takeoff_angle_error_deg", 1, |_, _| "0.02,-0.5".to_owned());
        let measured =
            |measured: &MeasuredErrors, beside: &Uncertainty| Uncertainty { measured: Some(measured.clone()), ..beside.clone() };
        let none = Uncertainty::NONE;
        let cases = [
            ("deviations", speed.clone(), 0.01),
            ("with biases", lasting.clone(), 0.01),
            ("three of speed", three.clone(), 0.01),
            ("rows of speed and angle", measured(&both, &none), 0.01),
            ("rows of a speed", measured(&in_m_s, &none), 0.01),
            ("rows of angle", measured(&angle_alone, &Uncertainty { takeoff_angle_sigma: degrees(0.0), ..speed.clone() }), 0.01),
            ("rows and biases", measured(&both, &bias_alone), 0.015),
            ("one row", measured(&one, &none), 0.0),
        ];
        let speed_m_s = 5.0;
        for distribution in Distribution::ALL {
            for (name, errors, within) in &cases {
                let errors = Uncertainty { distribution, ..errors.clone() };
                errors.check(true).expect("valid errors");
                let spread = CommandSpread::of(&errors);
                let drawn = Errors::new(errors.clone(), false);
                let draws: Vec<_> = fixed_draws(4096, distribution, distribution).iter().map(|draw| drawn.fixed(draw)).collect();
                #[expect(clippy::cast_precision_loss, reason = "4 096 draws")]
                let share = |holds: &dyn Fn(&crate::flight::HopErrors) -> bool| {
                    draws.iter().filter(|errors| holds(errors)).count() as f64 / draws.len() as f64
                };
                for room in [-2.0, -1.0, -0.3, 0.0, 0.2, 0.5, 0.8, 1.0, 1.5, 1.7, 2.0, 3.0] {
                    let (room_m_s, room_rad) = (0.1 * room + 1e-6, Angle::from_degrees(room + 1e-6).radians());
                    let of_speed = share(&|errors| speed_m_s * errors.speed_fraction + errors.speed_m_s <= room_m_s);
                    let of_angle = share(&|errors| (-0.02..=room_rad).contains(&errors.angle_rad));
                    let found = [spread.of_speed(speed_m_s).share_below(room_m_s), spread.angle_within(0.02, room_rad)];
                    for (found, flown) in found.into_iter().zip([of_speed, of_angle]) {
                        assert!((found - flown).abs() <= *within, "{name}, {distribution:?}, {room}: {found}, drawn {flown}");
                    }
                }
            }
        }
    }

    /// A plan on a limit keeps it where nothing is wrong with its commands.
    #[test]
    fn without_errors_every_limit_is_kept() {
        let spread = CommandSpread::of(&Uncertainty::NONE);
        for room in [-1e-9, 0.0, 1.0] {
            assert_eq!((spread.landing_speed_below(5.0, 5.0, 5.0 + room), spread.angle_within(room, room)), (1.0, 1.0), "{room}");
        }
    }
}
