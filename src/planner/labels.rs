//! Labels of nodes: what the paths to a node take, as far as the search compares it.

use std::cmp::Ordering;

use super::{Amount, Amounts, Budgets, Objective, OutagePart, Stretch};

/// No label, or the end of a list.
pub(super) const NONE: u32 = u32::MAX;

/// The amounts that a search follows: those of the objective, then those with a budget only.
#[derive(Clone, Debug)]
pub(super) struct Tracked {
    amounts: Vec<Amount>,
    /// How many of them are the objective.
    objective: usize,
    /// Those that a label has to have no more of, each by itself, to dominate another one.
    compared: Vec<usize>,
    /// The greatest total of each; infinite without one.
    allowed: Vec<f64>,
    /// The longest stretches outside the layers that may be left for a while.
    outages: Vec<Stretch>,
    /// What paths begin with: a path that follows another one may begin in a stretch.
    begins: OutagePart,
    /// The stretch, of each layer, that every path ends with at least.
    ends: Vec<Stretch>,
}

impl Tracked {
    /// For an objective within budgets.
    pub(super) fn new(objective: &Objective, budgets: &Budgets) -> Self {
        Self::of(objective.amounts(), budgets)
    }

    /// For all best totals of one amount against another: the queue has the first in ascending order and, of equals, the second, so that a label
    /// that is taken from it is seldom dominated by a later one.
    pub(super) fn front(first: Amount, second: Amount, budgets: &Budgets) -> Self {
        let mut tracked = Self::of(&[first, second], budgets);
        if !tracked.compared.contains(&1) {
            tracked.compared.push(1);
        }
        tracked
    }

    fn of(objective: &[Amount], budgets: &Budgets) -> Self {
        let mut amounts = objective.to_vec();
        amounts.extend(budgets.all().map(|(amount, _)| amount).filter(|amount| !objective.contains(amount)));
        let allowed: Vec<f64> = amounts.iter().map(|amount| budgets.allowed(*amount)).collect();
        // A label that is no worse by the objective has no more of its first amount; a greatest speed within its budget stays there.
        let compared = (1..amounts.len()).filter(|&i| allowed[i].is_finite() && amounts[i].adds_up()).collect();
        let (outages, ends) = (Vec::new(), Vec::new());
        Self { objective: objective.len(), amounts, compared, allowed, outages, begins: OutagePart::HELD, ends }
    }

    /// The same for paths with stretches no longer than these outside the conditions of layers.
    pub(super) fn under(self, outages: Vec<Stretch>, begins: OutagePart) -> Self {
        Self { ends: vec![Stretch::NONE; outages.len()], outages, begins, ..self }
    }

    /// The same where every path to the goal ends with stretches at least as long as these.
    pub(super) fn ending_with(self, ends: Vec<Stretch>) -> Self {
        debug_assert_eq!(ends.len(), self.outages.len(), "a stretch for each layer");
        Self { ends, ..self }
    }

    /// Whether stretches outside the conditions of layers count.
    pub(super) const fn has_outages(&self) -> bool {
        !self.outages.is_empty()
    }

    /// How many numbers a label has: the amounts, and what it keeps of each outage.
    pub(super) const fn width(&self) -> usize {
        self.amounts.len() + OutagePart::WIDTH * self.outages.len()
    }

    /// What a label keeps of an outage.
    pub(super) fn outage_of(&self, totals: &[f64], layer: usize) -> OutagePart {
        OutagePart::of_kept(&totals[self.amounts.len() + OutagePart::WIDTH * layer..][..OutagePart::WIDTH])
    }

    /// Writes into `totals` what a path of these numbers keeps of every outage after one more part; false if a stretch gets too long.
    pub(super) fn go_outside(&self, before: &[f64], totals: &mut [f64], part: &dyn Fn(usize) -> OutagePart) -> bool {
        let kept = totals[self.amounts.len()..].chunks_exact_mut(OutagePart::WIDTH);
        kept.zip(&self.outages).enumerate().all(|(layer, (kept, most))| {
            let joined = self.outage_of(before, layer).then(&part(layer), *most);
            joined.map(|joined| kept.copy_from_slice(&joined.kept())).is_some()
        })
    }

    /// The same for paths of which one of the amounts is at most so much: others are left out, but labels are not compared by it.
    pub(super) fn at_most(mut self, amount: Amount, most: f64) -> Self {
        for (_, allowed) in self.amounts.iter().zip(&mut self.allowed).filter(|(known, _)| **known == amount) {
            *allowed = allowed.min(most * (1.0 + Budgets::TOLERANCE));
        }
        self
    }

    /// How many amounts they are.
    pub(super) const fn len(&self) -> usize {
        self.amounts.len()
    }
}

/// Where a label comes from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Origin {
    pub(super) node: u32,
    /// The label before it; [`NONE`] at the start.
    pub(super) before: u32,
    /// The command of the last leg.
    pub(super) command: u32,
}

/// All labels of a search. Those of one node are linked; of them, none dominates another.
#[derive(Debug)]
pub(super) struct Labels {
    pub(super) tracked: Tracked,
    /// Of each label as many as are tracked.
    totals: Vec<f64>,
    origins: Vec<Origin>,
    next: Vec<u32>,
    /// Whether a label still counts.
    alive: Vec<bool>,
    /// The first label of each node.
    heads: Vec<u32>,
    most: usize,
    most_of_node: usize,
    /// Whether labels were left out because there were too many.
    pub(super) capped: bool,
}

impl Labels {
    /// No labels of any node.
    pub(super) fn new(tracked: Tracked, nodes: usize, most: usize, most_of_node: usize) -> Self {
        Self {
            tracked,
            totals: Vec::new(),
            origins: Vec::new(),
            next: Vec::new(),
            alive: Vec::new(),
            heads: vec![NONE; nodes],
            // Labels are numbered in 32 bits.
            most: most.min(NONE as usize - 1),
            most_of_node,
            capped: false,
        }
    }

    /// The bytes that one label of so many tracked amounts takes in vectors that double their size, while one of them grows.
    pub(super) const fn bytes_per_label(amounts: usize) -> usize {
        3 * (amounts * size_of::<f64>() + size_of::<Origin>() + size_of::<u32>() + size_of::<bool>())
    }

    /// How many labels were made.
    pub(super) const fn len(&self) -> usize {
        self.origins.len()
    }

    /// How many nodes have labels.
    pub(super) fn labelled_nodes(&self) -> usize {
        self.heads.iter().filter(|head| **head != NONE).count()
    }

    pub(super) fn origin(&self, label: u32) -> Origin {
        self.origins[label as usize]
    }

    pub(super) fn is_alive(&self, label: u32) -> bool {
        self.alive[label as usize]
    }

    /// The tracked amounts of a label.
    pub(super) fn totals(&self, label: u32) -> &[f64] {
        let width = self.tracked.width();
        &self.totals[label as usize * width..][..width]
    }

    /// What a label keeps of an outage.
    pub(super) fn outage(&self, label: u32, layer: usize) -> OutagePart {
        self.tracked.outage_of(self.totals(label), layer)
    }

    /// The labels of a node that count.
    pub(super) fn of_node(&self, node: usize) -> impl Iterator<Item = u32> + '_ {
        std::iter::successors(Some(self.heads[node]), |label| self.next.get(*label as usize).copied())
            .take_while(|label| *label != NONE)
    }

    /// Adds a label to a node unless another one of the node dominates it, and drops those that it dominates.
    ///
    /// # Returns
    /// Its number, if it was added.
    pub(super) fn offer(&mut self, totals: &[f64], origin: Origin) -> Option<u32> {
        let node = origin.node as usize;
        let mut count = 0;
        for label in self.of_node(node) {
            if dominates(&self.tracked, self.totals(label), totals) {
                return None;
            }
            count += 1;
        }
        self.drop_dominated(node, totals, &mut count);
        if count >= self.most_of_node || self.len() >= self.most {
            self.capped = true;
            return None;
        }
        #[expect(clippy::cast_possible_truncation, reason = "at most as many labels as 32 bits number")]
        let label = self.len() as u32;
        self.totals.extend_from_slice(totals);
        self.origins.push(origin);
        self.next.push(self.heads[node]);
        self.alive.push(true);
        self.heads[node] = label;
        Some(label)
    }

    fn drop_dominated(&mut self, node: usize, totals: &[f64], count: &mut usize) {
        let (mut before, mut label) = (NONE, self.heads[node]);
        while label != NONE {
            let next = self.next[label as usize];
            if dominates(&self.tracked, totals, self.totals(label)) {
                self.alive[label as usize] = false;
                match self.next.get_mut(before as usize) {
                    Some(link) => *link = next,
                    None => self.heads[node] = next,
                }
                *count -= 1;
            } else {
                before = label;
            }
            label = next;
        }
    }

    /// Whether a label of a node dominates these amounts.
    pub(super) fn node_dominates(&self, node: usize, totals: &[f64]) -> bool {
        self.of_node(node).any(|label| dominates(&self.tracked, self.totals(label), totals))
    }

    /// Whether a label of a node is better in the first amount of the objective alone than a path with one more leg could be; asked first, since
    /// it is cheap. Where labels are compared by more than the objective it is never certain.
    #[inline]
    pub(super) fn node_is_ahead(&self, node: usize, label: u32, leg: &Amounts) -> bool {
        let (width, first) = (self.tracked.width(), self.tracked.amounts[0]);
        let known = self.heads[node];
        self.tracked.compared.is_empty()
            && !self.tracked.has_outages()
            && known != NONE
            && self.totals[known as usize * width] < first.join(self.totals[label as usize * width], leg.of(first))
    }

    /// The tracked amounts of a path with one more leg, and the least of what it may keep of outages.
    pub(super) fn extended(&self, label: u32, leg: &Amounts, out: &mut Vec<f64>) {
        out.clear();
        let joined = |(amount, total): (&Amount, &f64)| amount.join(*total, leg.of(*amount));
        out.extend(self.tracked.amounts.iter().zip(self.totals(label)).map(joined));
        out.extend(self.tracked.least_outages(self.totals(label), &|_| Stretch::NONE));
    }
}

impl Tracked {
    /// What whole paths take at least that begin with these amounts; `None` if that is more than a budget.
    ///
    /// At a goal, and where nothing is left to come, these amounts themselves.
    pub(super) fn with_rest(&self, totals: &[f64], rest: &Amounts, out: &mut Vec<f64>) -> bool {
        // A sum is rounded: what is left out here keeps it from exceeding that of a path.
        const ROUNDING: f64 = 1.0 - 8.0 * f64::EPSILON;
        out.clear();
        for ((amount, total), allowed) in self.amounts.iter().zip(totals).zip(&self.allowed) {
            let rest = rest.of(*amount);
            let whole = if rest > 0.0 { (amount.join(*total, rest) * ROUNDING).max(*total) } else { *total };
            if whole > *allowed {
                return false;
            }
            out.push(whole);
        }
        out.extend(self.least_outages(totals, &|layer| self.ends[layer]));
        true
    }

    /// What is kept of outages at least, after whatever follows these numbers.
    fn least_outages<'s>(&'s self, totals: &'s [f64], end: &'s dyn Fn(usize) -> Stretch) -> impl Iterator<Item = f64> + 's {
        let kept = totals[self.amounts.len()..].chunks_exact(OutagePart::WIDTH).enumerate();
        kept.flat_map(|(layer, kept)| OutagePart::least_after(kept, end(layer)))
    }

    /// What the labels of a path without legs have.
    pub(super) fn zeros(&self) -> Vec<f64> {
        let amounts = std::iter::repeat_n(0.0, self.amounts.len());
        amounts.chain(self.outages.iter().flat_map(|_| self.begins.kept())).collect()
    }

    /// What the queue compares: the objective, filled up with zeros.
    pub(super) fn key(&self, totals: &[f64]) -> [f64; Objective::MOST] {
        let mut key = [0.0; Objective::MOST];
        key.iter_mut().zip(&totals[..self.objective]).for_each(|(key, total)| *key = *total);
        key
    }
}

/// Whether a path with the first amounts is no worse than one with the second, however both go on.
fn dominates(tracked: &Tracked, first: &[f64], second: &[f64]) -> bool {
    by_objective(&first[..tracked.objective], &second[..tracked.objective]) != Ordering::Greater
        && tracked.compared.iter().all(|&i| first[i] <= second[i])
        && first[tracked.amounts.len()..].iter().zip(&second[tracked.amounts.len()..]).all(|(first, second)| first <= second)
}

/// The order by the objective.
pub(super) fn by_objective(first: &[f64], second: &[f64]) -> Ordering {
    first.iter().zip(second).map(|(a, b)| a.total_cmp(b)).find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
}
