//! Robot files and kinds of cones that `trade` varies.

use std::path::PathBuf;

use chta::ballistics::stance::ConeKind;

use super::Failure;

/// The robot files and the cones of the options.
pub(crate) fn varied(given: &[String]) -> Result<(Vec<PathBuf>, Vec<ConeKind>), Failure> {
    let (mut robots, mut cones) = (Vec::new(), Vec::new());
    for text in given {
        let (key, values) = text.split_once('=').unwrap_or((text, ""));
        let values: Vec<&str> = values.split(',').map(str::trim).filter(|value| !value.is_empty()).collect();
        let names = ConeKind::ALL.map(ConeKind::name).join(",");
        match key.trim() {
            "robot.file" if !values.is_empty() && robots.is_empty() => robots.extend(values.iter().map(PathBuf::from)),
            "robot.cone" if !values.is_empty() && cones.is_empty() => {
                for value in values {
                    let kind = ConeKind::ALL.into_iter().find(|kind| kind.name() == value);
                    let wrong = || Failure::message(format!("--vary {text}: found the cone `{value}`, expected one of {names}"));
                    cones.push(kind.ok_or_else(wrong)?);
                }
            }
            _ => {
                return Err(Failure::message(format!(
                    "--vary {text}: expected robot.cone={names} or robot.file=FILE,FILE, each once, for a scenario of a robot with legs; its numbers \
                     are varied one by one, with --set"
                )));
            }
        }
    }
    Ok((robots, cones))
}
