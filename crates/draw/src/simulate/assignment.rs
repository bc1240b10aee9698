//! The cheapest way to pair the rows of a square cost matrix with its columns.

/// For each row its column, so that the sum of the costs is least: the Hungarian method with
/// potentials, [Kuhn1955](jurist_algebra::bibliography#kuhn1955), O(n^3). Costs must be finite.
pub(super) fn cheapest_assignment(cost: &[Vec<f64>]) -> Vec<usize> {
    let n = cost.len();
    // Rows and columns count from 1; column 0 stands for the row that is being placed.
    let (mut row_price, mut column_price) = (vec![0.0; n + 1], vec![0.0; n + 1]);
    let mut row_of = vec![0usize; n + 1];
    for row in 1..=n {
        row_of[0] = row;
        let mut column = 0;
        let mut slack = vec![f64::INFINITY; n + 1];
        let mut came_from = vec![0usize; n + 1];
        let mut visited = vec![false; n + 1];
        loop {
            visited[column] = true;
            let here = row_of[column];
            let (mut step, mut next) = (f64::INFINITY, 0);
            for j in (1..=n).filter(|&j| !visited[j]) {
                let reduced = cost[here - 1][j - 1] - row_price[here] - column_price[j];
                if reduced < slack[j] {
                    slack[j] = reduced;
                    came_from[j] = column;
                }
                if next == 0 || slack[j] < step {
                    step = slack[j];
                    next = j;
                }
            }
            for j in 0..=n {
                if visited[j] {
                    row_price[row_of[j]] += step;
                    column_price[j] -= step;
                } else {
                    slack[j] -= step;
                }
            }
            column = next;
            if row_of[column] == 0 {
                break;
            }
        }
        while column != 0 {
            let previous = came_from[column];
            row_of[column] = row_of[previous];
            column = previous;
        }
    }
    let mut assigned = vec![0; n];
    for column in 1..=n {
        assigned[row_of[column] - 1] = column - 1;
    }
    assigned
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn total(cost: &[Vec<f64>], columns: &[usize]) -> f64 {
        columns.iter().enumerate().map(|(i, &j)| cost[i][j]).sum()
    }

    fn cheapest_by_trying_all(cost: &[Vec<f64>], row: usize, used: &mut Vec<usize>) -> f64 {
        if row == cost.len() {
            return total(cost, used);
        }
        let mut best = f64::INFINITY;
        for j in 0..cost.len() {
            if !used.contains(&j) {
                used.push(j);
                best = best.min(cheapest_by_trying_all(cost, row + 1, used));
                used.pop();
            }
        }
        best
    }

    #[test]
    fn nothing_and_one() {
        assert!(cheapest_assignment(&[]).is_empty());
        assert_eq!(cheapest_assignment(&[vec![7.0]]), vec![0]);
    }

    proptest! {
        #[test]
        fn as_cheap_as_the_best_of_all(cost in (1usize..6).prop_flat_map(|n| {
            proptest::collection::vec(proptest::collection::vec((0u32..20).prop_map(f64::from), n), n)
        })) {
            let columns = cheapest_assignment(&cost);
            let mut sorted = columns.clone();
            sorted.sort_unstable();
            prop_assert_eq!(sorted, (0..cost.len()).collect::<Vec<_>>());
            prop_assert_eq!(total(&cost, &columns), cheapest_by_trying_all(&cost, 0, &mut Vec::new()));
        }
    }
}
