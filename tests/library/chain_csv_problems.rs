//! Every kind of bad chain CSV: line, column, underlined text, and the important words of the message.

use chta::chain::csv::{CsvProblem, CsvProblems, read_chain_csv, read_pairs_csv};

/// Line, column, underlined text, column name, and words of the message.
type Expected<'a> = (u64, Option<u64>, &'a str, Option<&'a str>, &'a [&'a str]);

fn problems_of(source: &[u8]) -> CsvProblems {
    match read_chain_csv(source) {
        Err(problems) => problems,
        Ok(file) => panic!("{:?} was accepted: {file:?}", String::from_utf8_lossy(source)),
    }
}

fn assert_problem(problem: &CsvProblem, (line, column, underlined, name, words): Expected<'_>) {
    let text = problem.to_string();
    assert_eq!((problem.line, problem.column), (line, column), "{text}");
    assert_eq!(&problem.text[problem.span.clone()], underlined, "{text}");
    assert_eq!(problem.name.as_deref(), name, "{text}");
    for word in words {
        assert!(text.contains(word), "`{word}` is missing in: {text}");
    }
    assert!(!text.contains('\n') && text.starts_with("line ") && !problem.help.is_empty(), "{text}");
}

fn assert_problems(source: &str, expected: &[Expected<'_>]) {
    let CsvProblems { problems, more } = problems_of(source.as_bytes());
    let text: Vec<String> = problems.iter().map(ToString::to_string).collect();
    assert_eq!((problems.len(), more), (expected.len(), 0), "{source:?} gave {text:#?}");
    for (problem, &expected) in problems.iter().zip(expected) {
        assert_problem(problem, expected);
    }
}

const SIX: &str = "takeoff_min_deg,takeoff_max_deg,takeoff_speed_max_m_s,landing_min_deg,landing_max_deg,landing_speed_max_m_s";

#[test]
fn files_without_a_chain_are_refused() {
    assert_problems("", &[(1, None, "", None, &["an empty file", "x_m,z_m"])]);
    assert_problems("\u{feff}\r\n", &[(1, None, "", None, &["an empty file"])]);
    assert_problems("# a note\n", &[(1, None, "# a note", None, &["comments only", "x_m,z_m"])]);
    assert_problems("x_m,z_m\n", &[(1, None, "x_m,z_m", None, &["no row below the header", "at least 2 vertices"])]);
    assert_problems("x_m,z_m\n1,2", &[(2, None, "1,2", None, &["1 row below the header", "at least 2 vertices"])]);
    assert_problems("0,0\n1,2\n", &[(1, None, "0,0", None, &["numbers in the first row", "a header", "x_m,z_m"])]);
}

#[test]
fn headers_with_wrong_columns_are_refused() {
    assert_problems(
        "x,elevation\n0,0\n1,1\n",
        &[
            (1, None, "x,elevation", None, &["without x_m", "is `x` meant? rename it to x_m if its numbers are in m"]),
            (1, None, "x,elevation", None, &["without z_m", "name the column z_m"]),
        ],
    );
    assert_problems(
        "x_m,z_m, z_m\n0,0,0\n1,1,1\n",
        &[(1, Some(10), "z_m", Some("z_m"), &["`z_m` twice", "field 2", "each column once", "remove"])],
    );
}

/// Numbers with separators of thousands and decimal commas: the advice never chooses one of two meanings.
#[test]
fn numbers_in_other_notations_are_refused_with_every_meaning() {
    for (text, expected) in [
        ("\"1,000\"", "its comma separates thousands (then write 1000) or decimals (then write 1.000)"),
        ("\"-12,345\"", "(then write -12345) or decimals (then write -12.345)"),
        ("\"12,5\"", "write a decimal point, not a comma: 12.5"),
        ("\"0,125\"", "write a decimal point, not a comma: 0.125"),
        ("\"1.234,5\"", "with a decimal point: 1234.5;"),
        ("\"1,234.5\"", "with a decimal point: 1234.5;"),
        ("1 000", "with a decimal point: 1000;"),
        ("1'000", "with a decimal point: 1000;"),
        ("1\u{a0}000", "with a decimal point: 1000;"),
        ("1\u{202f}000,5", "found 3 fields"),
        ("\"1\u{202f}000,5\"", "with a decimal point: 1000.5;"),
        ("1,000", "a comma between thousands (write 1500, not 1,500)"),
    ] {
        let problems = problems_of(format!("x_m,z_m\n0,{text}\n8,0\n").as_bytes()).problems;
        assert_eq!(problems.len(), 1, "{text}: {problems:?}");
        assert!(problems[0].to_string().contains(expected), "{text}: {}", problems[0]);
    }
}

/// A quantity in another unit is converted, not renamed; beside the known column it is only one more column.
#[test]
fn columns_in_other_units_are_refused_with_their_factor() {
    for (header, expected) in [
        ("x_ft,z_m", "`x_ft`, in feet, expected a column x_m; multiply its numbers by 0.3048, then name it x_m"),
        ("x_m,z_km", "`z_km`, in kilometres, expected a column z_m; multiply its numbers by 1000,"),
        ("x_m,Z [ft]", "multiply its numbers by 0.3048"),
        (
            "x_m,z_m,friction_pct",
            "`friction_pct`, in percent, expected a column friction_coefficient; multiply its numbers by 0.01,",
        ),
        ("x_m,z_m,cross_slope_rad", "multiply its numbers by 57.29577951,"),
        ("x_m,z_m,takeoff_speed_max_km_h", "multiply its numbers by 0.2777777778,"),
    ] {
        let row = ["0", "0", "0"][..header.split(',').count()].join(",");
        let problems = problems_of(format!("{header}\n{row}\n").as_bytes());
        let text = problems.to_string();
        assert!(text.contains(expected) && !text.contains("rename it"), "{header}: {text}");
    }
    let both = read_chain_csv(b"x_m,z_m,z_ft\n0,0,0\n1,1,3.3\n").unwrap();
    assert!(both.warnings[0].contains("`z_ft` is ignored"), "{:?}", both.warnings);
}

#[test]
fn every_line_end_gives_the_same_chain() {
    let text = "# note\nx_m,z_m,friction_coefficient\n0,0,0.6\n4,1,0.7\n9,1,\n";
    let whole = read_chain_csv(text.as_bytes()).unwrap();
    for end in ["\r\n", "\r"] {
        assert_eq!(read_chain_csv(text.replace('\n', end).as_bytes()).unwrap(), whole, "{end:?}");
    }
    let open = read_chain_csv(text.trim_end().as_bytes()).unwrap();
    assert_eq!(
        (open.chain, open.warnings),
        (whole.chain, vec!["line 5: the file ends within this line, after 3 rows: make sure that it is whole".to_owned()])
    );
}

#[test]
fn other_separators_are_recognised() {
    assert_problems("x_m;z_m\n0,5;1\n", &[(1, None, "x_m;z_m", None, &["semicolons", "expected commas", "1.5, not 1,5"])]);
    assert_problems("\"x_m\"\t\"z_m\"\n0\t1\n", &[(1, None, "\"x_m\"\t\"z_m\"", None, &["tabs", "expected commas"])]);
}

#[test]
fn fields_that_are_not_finite_numbers_are_refused() {
    assert_problems(
        "# drawn\nx_m,z_m\n0,abc\n1,NaN\n2,-inf\n3,1e999\n4,\n5,5 m\n6,\"1,5\"\n7,0x10\n 8 , \"x\" \n",
        &[
            (3, Some(3), "abc", Some("z_m"), &["found `abc`", "a finite number", "such as 12.5"]),
            (4, Some(3), "NaN", Some("z_m"), &["found `NaN`", "a finite number"]),
            (5, Some(3), "-inf", Some("z_m"), &["found `-inf`", "a finite number"]),
            (6, Some(3), "1e999", Some("z_m"), &["found `1e999`", "a finite number", "1.8e308"]),
            (7, Some(3), "", Some("z_m"), &["found nothing", "a finite number"]),
            (8, Some(3), "5 m", Some("z_m"), &["write the number alone, 5:", "unit"]),
            (9, Some(3), "\"1,5\"", Some("z_m"), &["found `1,5`", "a decimal point, not a comma: 1.5"]),
            (10, Some(3), "0x10", Some("z_m"), &["found `0x10`"]),
            (11, Some(6), "\"x\"", Some("z_m"), &["found `x`"]),
        ],
    );
}

#[test]
fn values_out_of_their_range_are_refused() {
    assert_problems(
        "x_m,z_m,friction_coefficient,cross_slope_deg,keep_out\n0,0,-0.1,90.1,2\n1,0,inf,-1,yes\n2,0,,,\n",
        &[
            (2, Some(5), "-0.1", Some("friction_coefficient"), &["at least 0", "0.3 to 1.2"]),
            (2, Some(10), "90.1", Some("cross_slope_deg"), &["0 to 90 degrees"]),
            (2, Some(15), "2", Some("keep_out"), &["expected 0 or 1"]),
            (3, Some(5), "inf", Some("friction_coefficient"), &["finite"]),
            (3, Some(9), "-1", Some("cross_slope_deg"), &["0 to 90 degrees"]),
            (3, Some(12), "yes", Some("keep_out"), &["expected 0 or 1", "such as"]),
        ],
    );
    assert_problems(
        &format!("x_m,z_m,{SIX}\n0,0,60,900,-5,-271,-60,inf\n1,0,,,,,,\n"),
        &[
            (2, Some(8), "900", Some("takeoff_max_deg"), &["-270 to 270 degrees", "angles are degrees"]),
            (2, Some(12), "-5", Some("takeoff_speed_max_m_s"), &["at least 0 m/s", "without sign"]),
            (2, Some(15), "-271", Some("landing_min_deg"), &["-270 to 270 degrees"]),
            (2, Some(24), "inf", Some("landing_speed_max_m_s"), &["a finite speed", "never reached"]),
        ],
    );
}

#[test]
fn vertices_out_of_order_are_refused() {
    assert_problems(
        "x_m,z_m\n0,0\n2,1\n2.0,3\nx,0\n1,0\n3,0\n",
        &[
            (4, Some(1), "2.0", Some("x_m"), &["found `2.0`", "more than 2, the x_m of line 3"]),
            (5, Some(1), "x", Some("x_m"), &["found `x`"]),
            (6, Some(1), "1", Some("x_m"), &["found `1`", "more than 2.0, the x_m of line 4"]),
        ],
    );
    assert_problems(
        "x_m,z_m\n0,0\n1e-300,1e20\n1,0\n",
        &[(3, Some(1), "1e-300", Some("x_m"), &["too near the x_m of line 2", "a slope", "apart"])],
    );
    // An invalid z gives no slope, and does not hide an invalid x.
    assert_problems(
        "x_m,z_m\n0,0\n1e-300,?\n0,1e20\n",
        &[(3, Some(8), "?", Some("z_m"), &["found `?`"]), (4, Some(1), "0", Some("x_m"), &["more than 1e-300"])],
    );
}

#[test]
fn ragged_rows_are_refused() {
    assert_problems(
        "x_m,z_m,keep_out\n0,0,1\n1,5,0,0\n2\n3,0,\n",
        &[
            (3, Some(7), "0", None, &["found 4 fields", "expected 3 as in the header", "decimal comma"]),
            (4, None, "2", None, &["found 1 field,", "expected 3", "every comma"]),
        ],
    );
}

#[test]
fn a_ragged_row_gives_no_problems_of_columns() {
    // Neither "column filled" nor "both forms" is reported.
    let header = format!("x_m,z_m,friction_coefficient,{SIX}");
    let words = &["found 2 fields", "expected 9 as in the header"];
    assert_problems(&format!("{header}\n0,0,0.6,,,,,,\n1,0\n2,0,,,,,,,\n"), &[(3, None, "1,0", None, words)]);
    assert_problems(&format!("{header}\n0,0,,,,,,,\n1,0,,,,,,,\n2,0\n"), &[(4, None, "2,0", None, words)]);
}

#[test]
fn half_a_set_of_columns_is_refused() {
    assert_problems(
        "x_m,z_m,landing_max_deg,takeoff_min_deg,takeoff_max_deg,map_x_m,landing_min_deg\n0,0,-60,10,90,5,\n1,0,,,,6,\n",
        &[
            (
                1,
                Some(25),
                "takeoff_min_deg",
                None,
                &[
                    "found takeoff_min_deg, takeoff_max_deg, landing_max_deg without",
                    "all six columns for travel towards +x",
                    "add takeoff_speed_max_m_s, landing_speed_max_m_s and fill landing_min_deg",
                ],
            ),
            (1, Some(57), "map_x_m", None, &["map_x_m without map_y_m", "both map columns", "add map_y_m"]),
        ],
    );
    assert_problems(
        "x_m,z_m,reverse_takeoff_min_deg\n0,0,5\n1,0,\n",
        &[(1, Some(9), "reverse_takeoff_min_deg", None, &["travel towards -x", "reverse_landing_speed_max_m_s"])],
    );
}

#[test]
fn both_forms_in_one_file_are_refused() {
    let header = format!("x_m,z_m,friction_coefficient,{SIX}");
    assert_problems(
        &format!("{header}\n0,0,0.6,60,90,5,-90,-60,5\n1,0,,,,,,,\n"),
        &[(
            2,
            Some(9),
            "60",
            Some("takeoff_min_deg"),
            &["both friction_coefficient and takeoff_min_deg in one row", "one per file"],
        )],
    );
    assert_problems(
        &format!("{header}\n0,0,0.6,,,,,,\n1,0,,60,90,5,-90,-60,5\n2,0,,,,,,,\n"),
        &[(3, Some(6), "60", Some("takeoff_min_deg"), &["where line 2 has friction_coefficient", "one per file"])],
    );
}

#[test]
fn blanks_and_filled_last_rows_are_refused() {
    assert_problems(
        "x_m,z_m,friction_coefficient,map_x_m,map_y_m\n0,0,,0,0\n1,0,0.6,1,\n2,0,0.6,2,2\n3,0,,,3\n",
        &[
            (2, Some(5), "", Some("friction_coefficient"), &["found nothing", "as in line 3", "in every row, or in none"]),
            (3, Some(11), "", Some("map_y_m"), &["found nothing", "as in line 2"]),
            (5, Some(6), "", Some("map_x_m"), &["found nothing", "as in line 2"]),
        ],
    );
    assert_problems(
        "x_m,z_m,friction_coefficient,keep_out\n0,0,0.6,1\n1,0,0.7,0\n",
        &[(
            3,
            Some(5),
            "0.7",
            Some("friction_coefficient"),
            &["`0.7` in the last row", "no segment begins at the last vertex", "empty friction_coefficient, keep_out", "cut short"],
        )],
    );
}

#[test]
fn reversed_cones_are_refused() {
    assert_problems(
        &format!("x_m,z_m,{SIX}\n0,0,90,60,0,-60,-90,5\n1,0,,,,,,\n"),
        &[
            (2, Some(5), "90", Some("takeoff_min_deg"), &["found `90`", "at most 60, the takeoff_max_deg", "speed 0"]),
            (2, Some(13), "-60", Some("landing_min_deg"), &["found `-60`", "at most -90, the landing_max_deg"]),
        ],
    );
}

#[test]
fn files_that_are_not_text_are_refused() {
    for (source, line, words) in [
        (&b"x_m,z_m\n0,0\n1,\xff\n"[..], 3, ["0xff at offset 14", "UTF-8"]),
        (&b"x_m,z_m\r\n0,\0\r\n"[..], 2, ["0x00 at offset 11", "UTF-8"]),
        (&b"\xff\xfex\0_\0m\0"[..], 1, ["UTF-16", "save the file as CSV UTF-8"]),
        (&b"II*\0\x08\0\0\0"[..], 1, ["0x00 at offset 3", "a CSV file at all"]),
    ] {
        let CsvProblems { problems, more } = problems_of(source);
        assert_eq!((problems.len(), more), (1, 0));
        assert_problem(&problems[0], (line, None, "", None, &words));
    }
    assert_problems(
        "x_m,z_m\n0,0\n1,\"2\n3,4\n",
        &[(3, Some(3), "\"", None, &["a quote that is never closed", "close the quote"])],
    );
}

#[test]
fn a_line_without_end_is_refused_in_little_space() {
    for source in [vec![b'7'; 64 << 20], [b"x_m,z_m\n0,0\n1,", &vec![b'7'; 64 << 20][..], b"\n"].concat()] {
        let CsvProblems { problems, .. } = problems_of(&source);
        assert!(problems[0].to_string().contains("a line of more than 65536 bytes"), "{}", problems[0]);
        let size: usize = problems.iter().map(|p| p.text.len() + p.found.len() + p.expected.len() + p.help.len()).sum();
        assert!(size < 2000, "the problems hold {size} bytes");
    }
    // Long, but not too long: the message shows an excerpt.
    let source = format!("x_m,z_m,note\n0,{},{}\n1,1,\n", "9".repeat(30_000), "n".repeat(30_000));
    let CsvProblems { problems, .. } = problems_of(source.as_bytes());
    assert_eq!((problems.len(), problems[0].column), (1, Some(3)));
    assert!(problems[0].text.len() < 200 && problems[0].text[problems[0].span.clone()].starts_with("9999"));
    assert!(problems[0].to_string().len() < 300, "{}", problems[0]);
}

#[test]
fn the_list_of_problems_is_cut_off() {
    let source = format!("x_m,z_m\n{}", "a,b\n".repeat(1000));
    let problems = problems_of(source.as_bytes());
    assert_eq!((problems.problems.len(), problems.more), (50, 1950));
    assert!(problems.to_string().ends_with("\nand 1950 more problems"));
    assert_eq!(problems.to_string().lines().count(), 51);
}

#[test]
fn control_characters_are_escaped_in_messages() {
    let CsvProblems { problems, .. } = problems_of(b"x_m,z_m\n0,\x1b[31mred\n1,1\n");
    assert!(problems[0].to_string().contains(r"\u{1b}[31mred"), "{}", problems[0]);
}

#[test]
fn unknown_columns_give_warnings() {
    let file = read_chain_csv(b"note,x_m,z_m,friction,,keep_out\n\"a, b\",0,0,1,,\n,1,1,,,\n").unwrap();
    assert_eq!(
        file.warnings,
        [
            "line 1: unknown column `note` is ignored",
            "line 1: unknown column `friction` is ignored (the nearest known column is friction_coefficient)",
            "line 1: column 5 without a name is ignored",
            "column keep_out is empty in every row and is ignored",
        ]
    );
    let many = format!("x_m,z_m{}\n0,0{}\n1,1{}\n", ",note".repeat(25), ",".repeat(25), ",".repeat(25));
    let warnings = read_chain_csv(many.as_bytes()).unwrap().warnings;
    assert_eq!((warnings.len(), warnings[20].as_str()), (21, "5 more unknown columns are ignored"));
}

#[test]
fn a_chain_with_one_direction_gives_a_warning() {
    let forward = format!("x_m,z_m,{SIX}\n0,0,60,93.5,10,-93.5,-60,0\n1,0,,,,,,\n");
    assert_eq!(read_chain_csv(forward.as_bytes()).unwrap().warnings, ["no hop goes towards -x: the chain has no reverse_ columns"]);
    let reverse = forward.replace("takeoff", "reverse_takeoff").replace("landing", "reverse_landing");
    assert_eq!(
        read_chain_csv(reverse.as_bytes()).unwrap().warnings,
        ["no hop goes towards +x: the chain has the reverse_ columns alone"]
    );
}

#[test]
fn problems_of_pairs_have_the_same_form() {
    let problems = read_pairs_csv(b"goal_x_m,start_x_m\n5,a\n,1\n").unwrap_err().problems;
    assert_problem(&problems[0], (2, Some(3), "a", Some("start_x_m"), &["found `a`", "a finite number"]));
    assert_problem(&problems[1], (3, Some(1), "", Some("goal_x_m"), &["found nothing"]));
    let problems = read_pairs_csv(b"start_x_m,goal_x_m\n").unwrap_err().problems;
    assert_problem(&problems[0], (1, None, "start_x_m,goal_x_m", None, &["no row", "at least 1 pair"]));
    let problems = read_pairs_csv(b"start,goal_x_m\n1,2\n").unwrap_err().problems;
    assert_problem(&problems[0], (1, None, "start,goal_x_m", None, &["without start_x_m", "is `start` meant"]));
    let file = read_pairs_csv(b"# two\r\ngoal_x_m,note,start_x_m\r\n5,,1\r\n1,,5\r\n").unwrap();
    assert_eq!(file.pairs.iter().map(|pair| (pair.start_x_m, pair.goal_x_m)).collect::<Vec<_>>(), [(1.0, 5.0), (5.0, 1.0)]);
    assert_eq!(file.warnings, ["line 2: unknown column `note` is ignored"]);
}
