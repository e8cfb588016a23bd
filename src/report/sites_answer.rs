//! Landing sites ranked, as plain data, text and CSV.

use std::{
    fmt::Write as _,
    io::{self, Write},
};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DeratingRecord;
use crate::planner::Amount;

/// The answer of `chta sites`: candidates for a landing site, best first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SitesAnswer {
    /// Every so many posts are nodes.
    pub stride: usize,
    /// Nodes for each spacing of the posts.
    pub nodes_per_post: usize,
    /// Nodes with an elevation.
    pub nodes: usize,
    /// What the paths have least: hops, unless the scenario has an objective.
    pub amount: Amount,
    /// The targets, [x, y], m: the nodes nearest to the places asked for.
    pub targets_m: Vec<[f64; 2]>,
    /// Searches over all nodes: one from every candidate, and one back to a candidate of every part.
    pub searches: usize,
    /// Trials flown from every candidate to each target that it reaches; absent if none were asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trials: Option<u64>,
    /// How many sets the candidates form of which each reaches the others: those of one set reach the same nodes, and are reached again from
    /// the same nodes.
    pub parts: usize,
    /// The shares of the limits that this answer is for; absent if it is for the whole limits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub derating: Option<DeratingRecord>,
    /// The candidates, best first; those without an answer last.
    pub sites: Vec<SiteRecord>,
}

/// A candidate for a landing site.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SiteRecord {
    /// Its place among all, from 1.
    pub rank: usize,
    /// Its number among the candidates, from 1.
    pub candidate: usize,
    /// The node, easting.
    pub x_m: f64,
    /// And northing.
    pub y_m: f64,
    /// Its distance from the place asked for.
    pub offset_m: f64,
    /// Nodes that it reaches, itself included.
    pub reachable_nodes: usize,
    /// Their share of all nodes with an elevation.
    pub reachable_share: f64,
    /// The share of the nodes that it reaches from which it can be reached again, itself included.
    pub return_share: f64,
    /// The mean of the hops to the nodes that it reaches; with targets, to those that it reaches; null if none but itself.
    pub mean_hops: Option<f64>,
    /// The most hops to any of them.
    pub greatest_hops: Option<i16>,
    /// The same mean of the amount of an objective; absent where that is hops.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean_total: Option<f64>,
    /// The greatest of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub greatest_total: Option<f64>,
    /// How many of the targets it reaches.
    pub targets_reached: usize,
    /// The hops to each target, in their order; null where it is not reached over these nodes.
    pub target_hops: Vec<Option<i16>>,
    /// Of trials of the paths to the targets, the share that arrives: the least of all targets; absent without trials, or where a target is not
    /// reached.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub success: Option<f64>,
    /// Why that is not known although trials were asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub success_missing: Option<String>,
    /// The share that arrives at each target, in their order; null where it is not reached over these nodes; empty without trials.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub target_success: Vec<Option<f64>>,
    /// To which set of candidates that reach each other it belongs, from 1.
    pub part: Option<usize>,
    /// Why no hop begins or ends there, or why it has no answer; null if hops do.
    pub refusal: Option<String>,
}

impl SiteRecord {
    /// The candidate that has no answer.
    pub const fn refused(candidate: usize, [x_m, y_m]: [f64; 2], refusal: String) -> Self {
        Self {
            rank: 0,
            candidate,
            x_m,
            y_m,
            offset_m: 0.0,
            reachable_nodes: 0,
            reachable_share: 0.0,
            return_share: 0.0,
            mean_hops: None,
            greatest_hops: None,
            mean_total: None,
            greatest_total: None,
            targets_reached: 0,
            target_hops: Vec::new(),
            success: None,
            success_missing: None,
            target_success: Vec::new(),
            part: None,
            refusal: Some(refusal),
        }
    }

    /// What is compared, the better first: an answer at all, targets reached, the share reached, the share of returns, then the least mean and the
    /// least greatest of the hops or of the amount; of equals the candidate that is listed first.
    fn order(&self, other: &Self) -> std::cmp::Ordering {
        let mean = |site: &Self| site.mean_total.or(site.mean_hops).unwrap_or(f64::INFINITY);
        let greatest = |site: &Self| site.greatest_total.or(site.greatest_hops.map(f64::from)).unwrap_or(f64::INFINITY);
        self.refusal
            .is_some()
            .cmp(&other.refusal.is_some())
            .then(other.targets_reached.cmp(&self.targets_reached))
            .then(if self.target_hops.is_empty() { std::cmp::Ordering::Equal } else { mean(self).total_cmp(&mean(other)) })
            .then(other.reachable_share.total_cmp(&self.reachable_share))
            .then(other.return_share.total_cmp(&self.return_share))
            .then(mean(self).total_cmp(&mean(other)))
            .then(greatest(self).total_cmp(&greatest(other)))
            .then(self.candidate.cmp(&other.candidate))
    }
}

impl SitesAnswer {
    /// Ranks the candidates.
    #[must_use]
    pub fn ranked(mut self) -> Self {
        self.sites.sort_by(SiteRecord::order);
        for (rank, site) in (1..).zip(&mut self.sites) {
            site.rank = rank;
        }
        self
    }

    /// Whether some candidate reaches all targets, or without targets any node but itself.
    pub fn has_site(&self) -> bool {
        let all = self.targets_m.len();
        self.sites.iter().any(|site| if all > 0 { site.targets_reached == all } else { site.reachable_nodes > 1 })
    }

    /// The answer as text; at most so many candidates are listed.
    pub fn text(&self) -> String {
        /// A page.
        const MOST: usize = 40;
        let node = if self.nodes_per_post > 1 { "node" } else { "post" };
        let mut text = format!(
            "{} candidates over {} {node}s; sets of them that reach each other: {}; searches over all {node}s: {}\n",
            self.sites.len(),
            self.nodes,
            self.parts,
            self.searches
        );
        // Writing to a String cannot fail.
        for (number, [x_m, y_m]) in (1..).zip(&self.targets_m) {
            let _ = writeln!(text, "target {number}: ({x_m:.3}, {y_m:.3}) m");
        }
        if let Some(derating) = &self.derating {
            let _ = writeln!(text, "{}", derating.sentence());
        }
        let of = if self.targets_m.is_empty() { "reached" } else { "targets" };
        let amount = (self.amount != Amount::Hops).then(|| format!("{:>16}", format!("mean {}", self.amount)));
        if let Some(trials) = self.trials {
            let _ = writeln!(text, "arrive: the least share of {trials} trials that arrive, over the targets");
        }
        let success = self.trials.map_or("", |_| " arrive (%)");
        let _ = writeln!(
            text,
            "\n{:>5}{:>10}{:>12}{:>12}{:>12}{:>11}{:>9}{:>13}{:>12}{}{success}  hops to targets",
            "rank",
            "candidate",
            "x (m)",
            "y (m)",
            "reached (%)",
            "back (%)",
            of,
            "mean hops",
            "most hops",
            amount.unwrap_or_default()
        );
        for site in self.sites.iter().take(MOST) {
            let _ = writeln!(text, "{}", self.line(site));
        }
        if self.sites.len() > MOST {
            let _ = writeln!(text, "and {} more; JSON and CSV have all", self.sites.len() - MOST);
        }
        text
    }

    fn line(&self, site: &SiteRecord) -> String {
        let or_none = |value: Option<String>| value.unwrap_or_else(|| "-".to_owned());
        let hops = site.target_hops.iter().map(|hops| or_none(hops.map(|hops| hops.to_string()))).collect::<Vec<_>>().join(" ");
        let count = if self.targets_m.is_empty() { site.reachable_nodes } else { site.targets_reached };
        let amount =
            (self.amount != Amount::Hops).then(|| format!("{:>16}", or_none(site.mean_total.map(|mean| format!("{mean:.3}")))));
        let success = self
            .trials
            .map_or(String::new(), |_| format!("{:>11}", or_none(site.success.map(|share| format!("{:.2}", 100.0 * share)))));
        let refusal = site.refusal.as_ref().map(|refusal| format!("  {refusal}")).unwrap_or_default();
        format!(
            "{:>5}{:>10}{:>12.3}{:>12.3}{:>12.2}{:>11.2}{count:>9}{:>13}{:>12}{}{success}  {hops}{refusal}",
            site.rank,
            site.candidate,
            site.x_m,
            site.y_m,
            100.0 * site.reachable_share,
            100.0 * site.return_share,
            or_none(site.mean_hops.map(|mean| format!("{mean:.3}"))),
            or_none(site.greatest_hops.map(|most| most.to_string())),
            amount.unwrap_or_default()
        )
    }

    /// Writes the candidates as CSV: one a row, best first, with a column of hops for each target, and with trials one of the share that arrives.
    ///
    /// # Errors
    /// [`io::Error`] from `out`.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut rows = csv::Writer::from_writer(out);
        let targets = (1..=self.targets_m.len()).map(|number| format!("hops_to_target_{number}"));
        let of_trials = self.trials.map_or(0, |_| self.targets_m.len());
        let success = (1..=of_trials).map(|number| format!("success_to_target_{number}"));
        let columns = COLUMNS.into_iter().map(str::to_owned).chain(targets).chain(success);
        rows.write_record(columns)?;
        for site in &self.sites {
            let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
            let whole = |value: Option<i16>| value.map_or(String::new(), |value| value.to_string());
            let own = [
                site.rank.to_string(),
                site.candidate.to_string(),
                site.x_m.to_string(),
                site.y_m.to_string(),
                site.offset_m.to_string(),
                site.reachable_nodes.to_string(),
                site.reachable_share.to_string(),
                site.return_share.to_string(),
                number(site.mean_hops),
                whole(site.greatest_hops),
                number(site.mean_total),
                number(site.greatest_total),
                site.targets_reached.to_string(),
                number(site.success),
                site.success_missing.clone().unwrap_or_default(),
                site.part.map_or(String::new(), |part| part.to_string()),
                site.refusal.clone().unwrap_or_default(),
            ];
            let hops = (0..self.targets_m.len()).map(|target| whole(site.target_hops.get(target).copied().flatten()));
            let success = (0..of_trials).map(|target| number(site.target_success.get(target).copied().flatten()));
            rows.write_record(own.into_iter().chain(hops).chain(success))?;
        }
        rows.flush()
    }
}

/// The columns of [`SitesAnswer::write_csv`], before those of targets.
const COLUMNS: [&str; 17] = [
    "rank",
    "candidate",
    "x_m",
    "y_m",
    "offset_m",
    "reachable_nodes",
    "reachable_share",
    "return_share",
    "mean_hops",
    "greatest_hops",
    "mean_total",
    "greatest_total",
    "targets_reached",
    "success",
    "success_missing",
    "part",
    "refusal",
];
