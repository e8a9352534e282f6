//! Patches of a map, one a visit, in as few states as explain them.

/// What a visit saw of the cells of a part: occupied, free, or nothing.
pub(super) type VisitPatch = Vec<Option<bool>>;

/// A state that patches were found in.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PartState {
    /// Of each cell the share of the visits in it that saw it occupied, with one half look of each kind before.
    pub(super) occupied: Vec<f64>,
    /// The visits.
    pub(super) members: Vec<usize>,
}

/// The states of the patches, the most frequent first: the number of them, up to `most`, that has the least Bayesian information criterion. Each cell of
/// each state is one parameter.
pub(super) fn states(patches: &[VisitPatch], most: usize) -> Vec<PartState> {
    let mut best: Option<(f64, Vec<PartState>)> = None;
    for count in 1..=most.min(patches.len()) {
        let found = in_states(patches, count);
        let criterion = criterion(patches, &found);
        if best.as_ref().is_none_or(|(least, _)| criterion < *least) {
            best = Some((criterion, found));
        }
    }
    let mut found = best.map_or_else(Vec::new, |(_, found)| found);
    found.sort_by_key(|cluster| std::cmp::Reverse(cluster.members.len()));
    found
}

/// Patches in so many states or fewer, each in the likeliest.
fn in_states(patches: &[VisitPatch], count: usize) -> Vec<PartState> {
    // Begun with patches that are the furthest from those before.
    let mut first = vec![0];
    while first.len() < count {
        let nearest = |at: usize| {
            first
                .iter()
                .map(|&of| differing(&patches[at], &patches[of]))
                .min()
        };
        let next = (0..patches.len()).max_by_key(|&at| (nearest(at), std::cmp::Reverse(at)));
        first.extend(next);
    }
    let mut of: Vec<usize> = Vec::new();
    let mut clusters: Vec<PartState> = first.iter().map(|&at| cluster(patches, vec![at])).collect();
    // Each round adds to the likelihood, so that no assignment comes twice.
    loop {
        let likeliest = |patch: &VisitPatch| {
            let ranked = clusters.iter().enumerate();
            let of = ranked.max_by(|(_, a), (_, b)| {
                log_likelihood(patch, a).total_cmp(&log_likelihood(patch, b))
            });
            of.map_or(0, |(number, _)| number)
        };
        let now: Vec<usize> = patches.iter().map(likeliest).collect();
        if now == of {
            break;
        }
        of = now;
        let members = |number: usize| (0..patches.len()).filter(|&at| of[at] == number).collect();
        clusters = (0..clusters.len())
            .map(members)
            .filter(|members: &Vec<usize>| !members.is_empty())
            .map(|members| cluster(patches, members))
            .collect();
        let number_of = |at: usize| clusters.iter().position(|one| one.members.contains(&at));
        of = (0..patches.len()).filter_map(number_of).collect();
        if clusters.len() < 2 {
            break;
        }
    }
    clusters
}

fn differing(one: &VisitPatch, other: &VisitPatch) -> usize {
    let pairs = one.iter().zip(other);
    pairs
        .filter(|(a, b)| matches!((a, b), (Some(a), Some(b)) if a != b))
        .count()
}

fn cluster(patches: &[VisitPatch], members: Vec<usize>) -> PartState {
    let cells = patches.first().map_or(0, Vec::len);
    let share = |cell: usize| {
        let seen = members.iter().filter_map(|&at| patches[at][cell]);
        let (occupied, all) = seen.fold((0.5, 1.0), |(occupied, all), seen| {
            (occupied + f64::from(u8::from(seen)), all + 1.0)
        });
        occupied / all
    };
    PartState {
        occupied: (0..cells).map(share).collect(),
        members,
    }
}

/// Logarithm of the probability of a patch in a state; cells that were not seen say nothing.
fn log_likelihood(patch: &VisitPatch, state: &PartState) -> f64 {
    let cells = patch.iter().zip(&state.occupied);
    let of = |(seen, p): (&Option<bool>, &f64)| {
        seen.map(|occupied| libm::log(if occupied { *p } else { 1.0 - p }))
    };
    cells.filter_map(of).sum()
}

fn criterion(patches: &[VisitPatch], states: &[PartState]) -> f64 {
    let of_state = |state: &PartState| {
        let members = state.members.iter();
        members
            .map(|&at| log_likelihood(&patches[at], state))
            .sum::<f64>()
    };
    let log_likelihood: f64 = states.iter().map(of_state).sum();
    let cells = patches.first().map_or(0, Vec::len);
    let parameters = (states.len() * (cells + 1)) as f64;
    parameters * libm::log(patches.len() as f64) - 2.0 * log_likelihood
}
