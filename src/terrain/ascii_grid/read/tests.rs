//! Valid and invalid grids.

use super::*;

const HEADER: &str = "ncols 3\nnrows 2\nxllcorner 10\nyllcorner -20\ncellsize 2\nNODATA_value -1\n";

fn read(text: &str) -> Result<Dem, TerrainError> {
    read_ascii_grid_bytes(text.as_bytes())
}

fn problems(text: &str) -> (Vec<AsciiProblem>, usize) {
    match read(text) {
        Err(TerrainError::AsciiGrid { problems, further }) => (problems, further),
        other => panic!("{other:?}"),
    }
}

fn only_problem(text: &str) -> String {
    let (problems, further) = problems(text);
    assert_eq!((problems.len(), further), (1, 0), "{problems:?}");
    problems[0].to_string()
}

#[test]
fn corner_and_centre_forms_of_one_grid_are_equal() {
    let rows = "1 2 3\n4 -1 6\n";
    let corner = read(&format!("{HEADER}{rows}")).unwrap();
    assert_eq!(corner.georeference().north_west(), MapPoint::new(11.0, -17.0));
    assert_eq!(corner.elevations().collect::<Vec<_>>(), [Some(1.0), Some(2.0), Some(3.0), Some(4.0), None, Some(6.0)]);
    for header in [
        "NROWS 2\nNCols 3\nXLLCENTER 11\nyllcenter -19\nCELLSIZE 2\nnodata_VALUE -1\n",
        "ncols 3 nrows 2 xllcorner 10 yllcenter -19 dx 2 dy 2 NODATA_value -1.0\n",
        "# made\n// by\n% hand\nncols 3 # columns\nnrows 2\n! corner\nxllcorner 10\nyllcorner -20\ncellsize 2\nNODATA -1\n",
        "ncols 3\rnrows 2\rxllcentre 11\ryllcentre -19\rcellsize 2\rno_data -1\r",
        "\u{feff}ncols 3\r\nnrows 2\r\nxllcorner 1e1\r\nyllcorner -2e1\r\ncellsize +2.0\r\nNODATA_value -1\r\n",
    ] {
        assert_eq!(read(&format!("{header}{rows}")).unwrap(), corner);
        assert!(AsciiGridReader.recognises(header.as_bytes()), "{header}");
    }
}

#[test]
fn keys_with_other_signs_are_recognised_and_named() {
    for (header, expected) in [
        ("ncols=3\nnrows=2\n", "ncols and its number with blanks"),
        ("NCOLS: 3\nnrows: 2\n", "line 1, column 1: found the header key 'NCOLS:'"),
        ("ncols,3\nnrows,2\n", "blanks between them"),
    ] {
        assert!(AsciiGridReader.recognises(header.as_bytes()), "{header}");
        let (found, _) = problems(header);
        assert!(found[0].to_string().contains(expected), "{}", found[0]);
    }
    assert!(!AsciiGridReader.recognises(b"ncolsx 3"));
}

#[test]
fn lines_are_counted_with_every_line_end() {
    for end in ["\n", "\r\n", "\r"] {
        let text = format!("{HEADER}1 2 3\n4 abc 6\n").replace('\n', end);
        assert!(only_problem(&text).starts_with("line 8, column 3"), "{end:?}");
    }
}

#[test]
fn rows_may_be_wrapped_anyhow() {
    let plain = read(&format!("{HEADER}1 2 3\n4 5 6\n")).unwrap();
    for rows in ["1\n2\n3\n4\n5\n6", "1 2 3 4 5 6", "\n\n 1\t2 3 4\r\n5  6  \n\n"] {
        assert_eq!(read(&format!("{HEADER}{rows}")).unwrap(), plain);
    }
}

#[test]
fn without_a_no_data_value_it_is_minus_9999() {
    let header = HEADER.replace("NODATA_value -1\n", "");
    let dem = read(&format!("{header}1 -1 -9999\nnan 5 6\n")).unwrap();
    assert_eq!(dem.elevations().collect::<Vec<_>>(), [Some(1.0), Some(-1.0), None, None, Some(5.0), Some(6.0)]);
    let not_a_number = HEADER.replace("value -1", "value NaN");
    assert_eq!(read(&format!("{not_a_number}1 -1 nan\n4 5 6\n")).unwrap().elevation(0, 2), None);
}

#[test]
fn spacings_may_differ() {
    let dem = read("ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ndx 4\ndy 10\n1 2\n3 4").unwrap();
    assert_eq!((dem.georeference().dx_m(), dem.georeference().dy_m()), (4.0, 10.0));
    assert_eq!(dem.georeference().north_west(), MapPoint::new(2.0, 15.0));
}

#[test]
fn every_problem_is_listed_with_its_place() {
    let (found, further) = problems(&format!("{HEADER}1,5 2 abc\n4 inf 6\n"));
    assert_eq!(further, 0);
    let places: Vec<(usize, usize)> = found.iter().map(|problem| (problem.line, problem.column)).collect();
    assert_eq!(places, [(7, 1), (7, 7), (8, 3)]);
    assert!(
        found[0].to_string().contains("'1,5'") && found[0].to_string().contains("write a decimal point, not a comma: 1.5"),
        "{}",
        found[0]
    );
    assert!(found[1].to_string().contains("row 1 of 2, column 3 of 3"), "{}", found[1]);
    let (found, _) = problems("ncols 3\nnrows x\nxllcorner 0\ncellsize -1\nncols 4\ncell 3\n1 2 3");
    let text = found.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n");
    for expected in
        ["line 2, column 7", "nrows 'x'", "ncols a second time", "'cell'", "cellsize -1", "no yllcorner and no yllcenter"]
    {
        assert!(text.contains(expected), "{expected}: {text}");
    }
}

#[test]
fn more_problems_than_twenty_are_counted() {
    let (found, further) = problems(&format!("{}1 {}", HEADER.replace("nrows 2", "nrows 20"), "x ".repeat(59)));
    assert_eq!((found.len(), further), (20, 39));
    let message = read(&format!("{}{}", HEADER.replace("nrows 2", "nrows 20"), "1 x 1 ".repeat(20))).unwrap_err().to_string();
    assert!(message.lines().count() == 20, "{message}");
}

#[test]
fn too_few_and_too_many_values_are_distinguished() {
    let few = only_problem(&format!("{HEADER}1 2 3\n4 5\n"));
    assert!(few.contains("end of the file after 5 values") && few.contains("6 (nrows 2 times ncols 3)"), "{few}");
    let many = only_problem(&format!("{HEADER}1 2 3\n4 5 6\n7 8\n"));
    assert!(many.contains("line 9, column 1: found 2 values too many"), "{many}");
}

#[test]
fn headers_that_contradict_themselves_are_refused() {
    let tail = "1 2 3 4 5 6";
    for (from, to, expected) in [
        ("cellsize 2", "cellsize 2\ndx 2", "cellsize beside dx or dy"),
        ("cellsize 2", "dx 2", "no dy"),
        ("xllcorner 10", "xllcorner 10\nxllcenter 11", "xllcorner and xllcenter"),
        ("ncols 3", "ncols 1", "at least 2"),
        ("ncols 3", "ncols 3.0", "whole number"),
        ("xllcorner 10", "xllcorner 10,5", "not a comma: 10.5"),
        ("xllcorner 10", "xllcorner 1,000", "thousands (then write 1000) or decimals (then write 1.000)"),
        ("xllcorner 10", "xllcorner inf", "finite"),
        ("NODATA_value -1", "NODATA_value none", "'none'"),
    ] {
        let message = only_problem(&format!("{}{tail}", HEADER.replace(from, to)));
        assert!(message.contains(expected), "{message}");
    }
}

#[test]
fn a_grid_in_degrees_is_refused_with_a_remedy() {
    let header = "ncols 3\nnrows 2\nxllcorner -122.2\nyllcorner 38\ncellsize 0.000277\n";
    let message = read(&format!("{header}12 14 19\n10 16 30\n")).unwrap_err().to_string();
    assert!(message.contains("degrees") && message.contains("gdalwarp"), "{message}");
    // A millimetre grid of a laboratory sand box is not mistaken for a map in degrees.
    assert!(read("ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 0.001\n0.001 0.002 0.001\n0 0 0.003\n").is_ok());
}

#[test]
fn an_empty_file_and_a_bare_header_say_what_is_missing() {
    let (found, _) = problems("");
    assert!(found.len() >= 4 && found[0].to_string().contains("no ncols"), "{found:?}");
    assert!(only_problem(HEADER).contains("end of the file after 0 values") || only_problem(HEADER).contains("bytes of file"));
}
