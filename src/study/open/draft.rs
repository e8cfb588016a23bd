//! A scenario before it is validated.

use std::{
    fs::File,
    io::Read,
    path::{Path, PathBuf},
};

use serde_json::Value;

use super::{CHAIN_TERRAIN, OpenCase, OpenError, Purpose, SLICED_TERRAIN, SharedInputs, relative_name};
use crate::{
    scenario::{Entries, FileKind, Place, Scenario, ScenarioProblem, ScenarioProblems},
    study::Case,
};

/// How a caller names itself and its files in warnings and documents.
#[derive(Clone, Copy, Debug)]
pub struct Wording {
    /// What it calls a question, such as `command`.
    pub question: &'static str,
    /// The settings with which a map uses more keys, for the end of a sentence.
    pub of_map: &'static str,
    /// The names of files in documents.
    pub file_name: fn(&Path) -> String,
}

impl Default for Wording {
    fn default() -> Self {
        let of_map = "goals, an effort, totals of amounts or trials";
        Self { question: "question", of_map, file_name: relative_name }
    }
}

/// The keys of a scenario before they are validated, and where they came from.
#[derive(Clone, Debug, Default)]
pub struct Draft {
    /// The keys.
    pub entries: Entries,
    /// The name of their file, with which problems begin; empty without a file.
    pub name: String,
    /// The text of the file, into which problems point; empty without one.
    pub text: String,
    /// The folder that paths start from.
    pub base: PathBuf,
    /// The result that they came from, whose path trials fly.
    pub result: Option<Value>,
    /// The caller's words.
    pub wording: Wording,
    /// What it reads together with other cases; absent: it reads everything by itself.
    pub shared: Option<SharedInputs>,
}

impl Draft {
    /// A scenario has some kilobytes, a result some megabytes: more bytes are not read.
    pub const LARGEST_BYTES: u64 = 1 << 24;

    /// Reads a scenario (TOML) or a result (JSON), by its content. Paths in a scenario start from its folder, those in a result from the
    /// working folder.
    ///
    /// # Errors
    /// [`OpenError::Unreadable`]. Problems of the keys are found when a question is asked.
    pub fn read(file: &Path) -> Result<Self, OpenError> {
        let name = file.display().to_string();
        let unread = |reason: String, help| OpenError::unreadable(&name, reason, help);
        let kind = FileKind::of(file).map_err(|error| unread(error.to_string(), CHECK_PATH))?;
        let has_ending = |known| file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(known));
        match kind {
            FileKind::Scenario => Self::read_scenario(file, &name, file.parent().unwrap_or(Path::new(""))),
            FileKind::Result | FileKind::Json => Self::read_result(file, name),
            _ if has_ending("json") => Self::read_result(file, name),
            _ if has_ending("toml") => Self::read_scenario(file, &name, file.parent().unwrap_or(Path::new(""))),
            other => Err(unread(format!("this is {}", other.name()), "give a scenario (TOML) or a result (JSON)")),
        }
    }

    /// Reads a scenario (TOML) whose paths start from the folder `base`. Without a title of its own it has the name of its file, unless it
    /// is called otherwise.
    ///
    /// # Errors
    /// [`OpenError::Unreadable`].
    pub fn read_scenario(file: &Path, name: &str, base: &Path) -> Result<Self, OpenError> {
        let mut draft = Self::of_toml(&read_bounded(file, name)?, name, base);
        if file == Path::new(name) {
            draft.entries.set_default_title(&file.file_stem().map(|stem| stem.to_string_lossy()).unwrap_or_default());
        }
        Ok(draft)
    }

    /// Reads a result (JSON), whose scenario is meant.
    ///
    /// # Errors
    /// [`OpenError::Unreadable`].
    pub fn read_result(file: &Path, name: String) -> Result<Self, OpenError> {
        const HELP: &str = "give a result.json that chta wrote";
        let text = read_bounded(file, &name)?;
        let result: Value = serde_json::from_str(&text).map_err(|error| OpenError::unreadable(&name, error.to_string(), HELP))?;
        match result.get("scenario") {
            Some(scenario) => {
                let entries = Entries::from_json(scenario);
                Ok(Self { entries, name, result: Some(result), ..Self::default() })
            }
            None => Err(OpenError::unreadable(&name, "it has no `scenario`".to_owned(), HELP)),
        }
    }

    /// The keys of a TOML text. `name`: what problems begin with; `base`: the folder that paths start from.
    pub fn of_toml(text: &str, name: &str, base: &Path) -> Self {
        let (name, text) = (name.to_owned(), text.to_owned());
        Self { entries: Entries::from_toml(&text), name, text, base: base.to_path_buf(), ..Self::default() }
    }

    /// The keys of tables, as the `scenario` of a document has them. `base`: the folder that paths start from.
    pub fn of_tables(tables: &Value, base: &Path) -> Self {
        Self { entries: Entries::from_json(tables), base: base.to_path_buf(), ..Self::default() }
    }

    /// Sets `table.key=value`, which replaces that key of the file. A value that is not valid TOML is taken as a text.
    pub fn set(&mut self, assignment: &str) {
        self.entries.set(assignment, assignment);
    }

    /// Removes the terrain, for a question that has its own.
    pub fn forget_terrain(&mut self) {
        for key in SLICED_TERRAIN.into_iter().chain(CHAIN_TERRAIN) {
            self.entries.forget("terrain", key);
        }
    }

    /// The file that a key names.
    pub fn file_of(&self, path: &str) -> Option<PathBuf> {
        let file = self.entries.files().into_iter().find(|(key, _)| key.path() == path);
        file.map(|(_, file)| self.base.join(file))
    }

    /// The scenario, validated. A robot with legs is refused unless it is answered for.
    ///
    /// # Errors
    /// All problems of the keys.
    pub fn validated(&self, stands_on_legs: bool) -> Result<Scenario, ScenarioProblems> {
        let robot = self.entries.files().into_iter().find(|(key, _)| key.path() == "robot.file");
        // For a point the plan would promise what a trunk and limbs do not keep.
        if let Some((key, file)) = robot.filter(|_| !stands_on_legs && !self.entries.is_unreadable()) {
            let question = self.wording.question;
            let message = format!("robot.file is \"{file}\", a robot with legs, and this {question} answers for a point alone");
            let over_dem = self.file_of("terrain.dem").is_some() && !self.entries.ask_for_legs_on_dem();
            let legs = if over_dem { "; plans and trials of legs over a dem need terrain.route = \"free\"" } else { "" };
            let help = format!("remove it from [robot]: [hopper] then states the limits of the point{legs}");
            return Err(self.refused(vec![self.entries.file_problem(key, message, help)]));
        }
        Scenario::new(self.entries.clone()).map_err(|problems| self.refused(problems))
    }

    /// Problems of the keys, with the file that they point into.
    pub fn refused(&self, problems: Vec<ScenarioProblem>) -> ScenarioProblems {
        let in_file = problems.iter().any(|problem| !matches!(problem.place, Place::Option(_)));
        let (name, source) = if in_file { (self.name.clone(), self.text.clone()) } else { Default::default() };
        ScenarioProblems { name, source, problems }
    }

    /// Opens the terrain for a question along a chain, of a free route over a DEM, of a mission or of a drive.
    ///
    /// # Errors
    /// [`OpenError`].
    pub fn case(&self, purpose: Purpose) -> Result<OpenCase, OpenError> {
        let (scenario, commands) = (self.validated(purpose.stands_on_legs())?, purpose.commands());
        let Some(shared) = &self.shared else {
            let case = Case::new(scenario, &self.base, commands)?;
            return Ok(OpenCase::new(case, purpose, [&self.entries; 2], &self.wording)?);
        };
        let case = shared.case(scenario, &self.base, commands)?;
        Ok(OpenCase::sharing(case, purpose, [&self.entries; 2], &self.wording, shared)?)
    }
}

/// How to mend a file that cannot be opened.
const CHECK_PATH: &str = "check the path and its permissions";

/// The text of a file.
pub(super) fn read_bounded(file: &Path, name: &str) -> Result<String, OpenError> {
    let unread = |reason: String, help| OpenError::unreadable(name, reason, help);
    let open = File::open(file).and_then(|opened| Ok((opened.metadata()?.len(), opened)));
    let (size, opened) = open.map_err(|error| unread(error.to_string(), CHECK_PATH))?;
    if size > Draft::LARGEST_BYTES {
        return Err(unread(format!("{size} bytes"), "a scenario has some kilobytes; give a chain or DEM inside it"));
    }
    let mut bytes = Vec::new();
    // Reading is bounded as well: the size of a pipe or device is not known in advance.
    let read = opened.take(Draft::LARGEST_BYTES).read_to_end(&mut bytes);
    read.map_err(|error| unread(error.to_string(), CHECK_PATH))?;
    String::from_utf8(bytes).map_err(|error| unread(error.to_string(), "write it as TOML in UTF-8"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A slope of 20 m, without a file.
    const SLOPE: &str = "[body]\nname = \"mars\"\n[hopper]\ntakeoff_speed_max_m_s = 6.0\nlanding_speed_max_m_s = 6.0\n\
                         [surface]\nfriction_coefficient = 0.6\n";

    #[test]
    fn a_text_that_is_no_scenario_names_its_position_and_a_setting_its_own() {
        let mut draft = Draft::of_toml("[body]\ngravity = 3\n", "mine.toml", Path::new(""));
        assert!(draft.validated(false).unwrap_err().to_string().starts_with("mine.toml:2:1: unknown key body.gravity"));
        draft = Draft::of_toml(SLOPE, "mine.toml", Path::new(""));
        draft.set("hopper.clearance_m=-5");
        let refused = draft.validated(false).unwrap_err();
        assert!(refused.to_string().starts_with("hopper.clearance_m=-5: hopper.clearance_m is -5"), "{refused}");
        assert_eq!(refused.name, "");
    }

    #[test]
    fn a_robot_with_legs_is_refused_where_a_point_is_answered_for() {
        let draft = Draft::of_toml(&format!("{SLOPE}[robot]\nfile = \"legs.toml\"\n"), "legs.toml", Path::new(""));
        let refused = draft.validated(false).unwrap_err().to_string();
        assert!(refused.contains("this question answers for a point alone"), "{refused}");
        assert!(draft.validated(true).is_ok());
    }

    #[test]
    fn what_is_no_scenario_is_refused_by_its_content() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| {
            let file = folder.path().join(name);
            std::fs::write(&file, text).unwrap();
            file
        };
        for (file, said) in [
            (write("chain.csv", "x_m,z_m\n0,0\n1,0\n"), "this is a chain CSV"),
            (write("other.json", "{\"a\": 1}"), "it has no `scenario`"),
            (write("half.json", "{\"scenario\": "), "EOF"),
            (folder.path().join("absent.toml"), "No such file"),
        ] {
            let refused = Draft::read(&file).unwrap_err().to_string();
            assert!(refused.contains(said) && refused.contains(&file.display().to_string()), "{refused}");
        }
        let titled = Draft::read(&write("slope.toml", SLOPE)).unwrap();
        assert_eq!(titled.entries.title(), Some("slope"));
        assert_eq!(titled.base, folder.path());
    }
}
