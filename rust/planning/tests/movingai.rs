//! Optimal costs of game maps (movingai.com); the folder with the data is named by `TREADWELL_DATA`, and none is no failure.

use planning::search::{Search, octile};

/// Rows of weights and their number of columns.
fn read_map(text: &str) -> (Vec<f32>, usize) {
    let rows: Vec<&str> = text
        .lines()
        .skip_while(|line| *line != "map")
        .skip(1)
        .collect();
    let cols = rows[0].len();
    let weight = |tile: char| {
        if matches!(tile, '.' | 'G') {
            1.0
        } else {
            f32::INFINITY
        }
    };
    (
        rows.iter()
            .flat_map(|row| row.chars().map(weight))
            .collect(),
        cols,
    )
}

#[test]
fn every_cost_of_the_game_maps_is_exact() {
    let Ok(data) = std::env::var("TREADWELL_DATA") else {
        eprintln!("skipped: TREADWELL_DATA is not set");
        return;
    };
    let mut search = Search::default();
    let mut lines = 0;
    for name in ["arena2.map", "den312d.map"] {
        let folder = std::path::Path::new(&data).join("movingai");
        let (weights, cols) = read_map(&std::fs::read_to_string(folder.join(name)).unwrap());
        let scenarios = std::fs::read_to_string(folder.join(format!("{name}.scen"))).unwrap();
        for line in scenarios
            .lines()
            .skip(1)
            .filter(|line| !line.trim().is_empty())
        {
            let fields: Vec<&str> = line.split_whitespace().collect();
            let number = |i: usize| fields[i].parse::<usize>().unwrap();
            let (start, end) = (number(5) * cols + number(4), number(7) * cols + number(6));
            let expected: f64 = fields[8].parse().unwrap();
            let heuristic = |cell: usize| {
                let (dx, dy) = (
                    (cell % cols).abs_diff(end % cols),
                    (cell / cols).abs_diff(end / cols),
                );
                octile(dx as f64, dy as f64)
            };
            let ending = |cell: usize| (cell == end).then_some(0.0);
            let found = search
                .run(&weights, cols, start, ending, heuristic)
                .unwrap();
            assert!(
                (found.cost - expected).abs() < 5.1e-4, // six digits of sums in single precision
                "{name}: {line}: {}",
                found.cost
            );
            lines += 1;
        }
    }
    assert!(lines > 100, "{lines} lines");
}
