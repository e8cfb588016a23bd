//! `chta batch`: many cases of one scenario.

use chta::study::{
    BatchRow, CaseTable,
    open::{Draft, SharedInputs},
};

use crate::cli::{
    Answer, Failure,
    args::{BatchArgs, TableFile},
    batch_folder::{BatchFolder, check_format, read_cases},
    inputs, interrupt,
    load::load_draft,
    output::{self, Pending},
    progress::Progress,
    threads,
    wrong_thing::Role,
};

/// Answers every case.
pub(crate) fn run(args: &BatchArgs) -> Result<Answer, Failure> {
    let text = Some(args.cases.as_path()).filter(|file| !CaseTable::is_parquet(file));
    let files = [(text, Role::Cases), (Some(args.scenario.as_path()), Role::ScenarioOption)];
    inputs::look_at(args.input_max_gib, &files)?;
    threads::start(args.threads)?;
    let draft = Draft { shared: Some(SharedInputs::default()), ..load_draft(&args.scenario, &args.set)? };
    let cases = read_cases(&args.cases)?;
    if let Some(file) = &args.collect {
        check_format(&format!("--collect {}", file.display()), TableFile::of(file))?;
    }
    let (mut folder, rows) = BatchFolder::open(&args.output, &cases, args.parts, args.resume)?;
    let collected = args.collect.as_deref().map(Pending::begin).transpose()?;
    let mut rows = folder.kept(rows, |case| cases.key(&draft, case));
    let kept = rows.len();
    let wanted: Vec<usize> = (0..cases.count()).filter(|case| !rows.contains_key(case)).collect();
    let progress = Progress::new(false);
    // Some cases for each thread, so that none waits long for the slowest.
    for some in wanted.chunks(4 * rayon::current_num_threads().max(1)) {
        let line = |_: &_| Some(format!("{} of {} cases", rows.len(), cases.count()));
        let answers: Vec<BatchRow> = cases.answers(&draft, some, &progress.with_lines(line));
        interrupt::check()?;
        folder.add(&answers)?;
        rows.extend(some.iter().copied().zip(answers.into_iter().map(|row| row.cells)));
    }
    drop(progress);
    folder.close()?;
    if let Some(file) = collected {
        folder.collect(&rows, file)?;
    }
    let with = |verdict: &str| rows.values().filter(|row| row.iter().any(|cell| cell == verdict)).count();
    let refused = rows.values().filter(|row| row.last().is_some_and(|error| !error.is_empty())).count();
    let text = format!(
        "cases: {}\ntraversable: {}\nrefused: {refused}\nkept from earlier: {kept}\nparts written: {}\n",
        rows.len(),
        with("traversable"),
        folder.written
    );
    output::to_stdout(text.as_bytes())?;
    Ok(Answer::Yes)
}
