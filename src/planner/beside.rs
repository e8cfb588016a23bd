//! The cells of a grid within a rectangle about any of some cells.

use std::ops::Range;

/// Of every row with such cells, ascending: their columns, as ascending ranges that do not touch.
pub(super) type RowRanges = Vec<(usize, Vec<Range<usize>>)>;

/// The cells of a grid of so many rows and columns that are at most so many rows down or up and so many columns aside from one of some cells.
///
/// # Arguments
/// `cells`: rows and columns, sorted.
///
/// # Complexity
/// Linear in the cells given, and for every row in the rows within reach: cells found are not visited one by one.
pub(super) fn cells_beside(cells: &[(usize, usize)], (rows, cols): (usize, usize), (down, aside): (usize, usize)) -> RowRanges {
    let sources: RowRanges = cells
        .chunk_by(|a, b| a.0 == b.0)
        .map(|of_row| {
            let ranges = of_row.iter().map(|(_, col)| col.saturating_sub(aside)..col.saturating_add(aside + 1).min(cols));
            (of_row[0].0, merged(ranges))
        })
        .collect();
    let (Some(first), Some(last)) = (sources.first(), sources.last()) else { return Vec::new() };
    let mut found = Vec::new();
    let mut from = 0;
    for row in first.0.saturating_sub(down)..last.0.saturating_add(down + 1).min(rows) {
        while sources.get(from).is_some_and(|(source, _)| source + down < row) {
            from += 1;
        }
        let near = sources[from..].iter().take_while(|(source, _)| *source <= row + down);
        let mut ranges: Vec<Range<usize>> = near.flat_map(|(_, ranges)| ranges.iter().cloned()).collect();
        ranges.sort_unstable_by_key(|range| range.start);
        if !ranges.is_empty() {
            found.push((row, merged(ranges)));
        }
    }
    found
}

/// Ranges in the order of their starts, those that overlap or touch as one.
fn merged(ranges: impl IntoIterator<Item = Range<usize>>) -> Vec<Range<usize>> {
    let mut all: Vec<Range<usize>> = Vec::new();
    for range in ranges {
        match all.last_mut() {
            Some(last) if range.start <= last.end => last.end = last.end.max(range.end),
            _ => all.push(range),
        }
    }
    all
}

/// Whether a cell is among those of some rows.
pub(super) fn holds(found: &RowRanges, (row, col): (usize, usize)) -> bool {
    let ranges = found.binary_search_by_key(&row, |(row, _)| *row).ok().and_then(|at| found.get(at));
    ranges.is_some_and(|(_, ranges)| ranges.iter().any(|range| range.contains(&col)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::Draw;

    #[test]
    fn cells_are_those_within_the_rectangle_of_one() {
        let draw = &mut Draw::seeded(1734);
        let mut found = 0;
        for _ in 0..300 {
            let (rows, cols) = (1 + draw.below(12), 1 + draw.below(15));
            let (down, aside) = (draw.below(4), draw.below(5));
            let mut cells: Vec<(usize, usize)> = (0..draw.below(8)).map(|_| (draw.below(rows), draw.below(cols))).collect();
            cells.sort_unstable();
            let all = cells_beside(&cells, (rows, cols), (down, aside));
            assert!(all.iter().all(|(_, ranges)| ranges.windows(2).all(|pair| pair[0].end < pair[1].start)), "{all:?}");
            for (row, col) in (0..rows).flat_map(|row| (0..cols).map(move |col| (row, col))) {
                let expected = cells.iter().any(|cell| cell.0.abs_diff(row) <= down && cell.1.abs_diff(col) <= aside);
                assert_eq!(holds(&all, (row, col)), expected, "{cells:?}: {row}, {col}");
                found += u32::from(expected);
            }
            assert!(all.iter().all(|(row, ranges)| *row < rows && ranges.iter().all(|range| range.end <= cols)));
        }
        assert!(found > 3000, "{found}");
    }
}
