//! A small set of rows in which every pair of positions of every two switches stands together at least once.

use std::collections::BTreeSet;

/// Two switches and a position of each.
type Pair = (usize, usize, usize, usize);

fn all(sizes: &[usize]) -> BTreeSet<Pair> {
    let mut pairs = BTreeSet::new();
    for (a, size_a) in sizes.iter().enumerate() {
        for (b, size_b) in sizes.iter().enumerate().skip(a + 1) {
            for in_a in 0..*size_a {
                for in_b in 0..*size_b {
                    pairs.insert((a, in_a, b, in_b));
                }
            }
        }
    }
    pairs
}

fn of_row(row: &[usize]) -> impl Iterator<Item = Pair> + '_ {
    (0..row.len()).flat_map(move |a| (a + 1..row.len()).map(move |b| (a, row[a], b, row[b])))
}

/// Pairs that no row holds.
pub(crate) fn uncovered(sizes: &[usize], rows: &[Vec<usize>]) -> usize {
    let mut left = all(sizes);
    for pair in rows.iter().flat_map(|row| of_row(row)) {
        left.remove(&pair);
    }
    left.len()
}

/// Greedy: each row begins with a pair that is still missing and takes for every other switch the position that brings
/// most missing pairs.
pub(crate) fn covering(sizes: &[usize]) -> Vec<Vec<usize>> {
    let mut left = all(sizes);
    let mut rows = Vec::new();
    while let Some((a, in_a, b, in_b)) = left.first().copied() {
        let mut row: Vec<Option<usize>> = vec![None; sizes.len()];
        (row[a], row[b]) = (Some(in_a), Some(in_b));
        for (switch, size) in sizes.iter().enumerate() {
            if row[switch].is_some() {
                continue;
            }
            let gain = |position: usize| {
                let fits = |(other, place): (usize, &Option<usize>)| {
                    let place = (*place)?;
                    let pair = if other < switch {
                        (other, place, switch, position)
                    } else {
                        (switch, position, other, place)
                    };
                    left.contains(&pair).then_some(())
                };
                row.iter().enumerate().filter_map(fits).count()
            };
            let best = (0..*size).rev().max_by_key(|position| gain(*position));
            row[switch] = best;
        }
        let row: Vec<usize> = row.into_iter().map(Option::unwrap).collect();
        for pair in of_row(&row) {
            left.remove(&pair);
        }
        rows.push(row);
    }
    rows
}

#[test]
fn a_covering_holds_all_pairs_in_few_rows() {
    for sizes in [&[2, 2][..], &[3, 4, 2], &[6, 4, 4, 3, 3, 3, 2, 2, 2]] {
        let rows = covering(sizes);
        assert_eq!(uncovered(sizes, &rows), 0);
        let product: usize = sizes.iter().product();
        assert!(rows.len() <= product.min(40), "{}", rows.len());
        assert!(uncovered(sizes, &rows[1..]) > 0, "the first row is needed");
    }
}
