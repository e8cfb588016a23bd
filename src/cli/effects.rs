//! How warnings about keys without effect name the options of the command.

pub(crate) use chta::study::open::Purpose;
use chta::study::open::Wording;

use super::load::relative_name;

/// The words of the command line.
pub(crate) const WORDING: Wording =
    Wording { question: "command", of_map: "--goal, --effort, --amount-output or --simulate", file_name: relative_name };

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::help::offers;

    #[test]
    fn every_question_is_a_command_and_the_options_of_the_wording_exist() {
        for purpose in Purpose::ALL {
            assert!(offers(purpose.name(), "set") || purpose == Purpose::Run, "{purpose:?}");
        }
        let named: Vec<_> = WORDING.of_map.split([' ', ',']).filter_map(|word| word.strip_prefix("--")).collect();
        assert_eq!(named.len(), 4);
        for option in named {
            assert!(offers("map", option), "map has no --{option}");
        }
    }
}
