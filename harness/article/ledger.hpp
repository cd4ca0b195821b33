/// The ledger: each statement of the article with the printed value, ours, the range over all runs
/// and a verdict.
#pragma once

#include <string>
#include <vector>

#include "harness/article/paper_run.hpp"
#include "harness/article/verdict.hpp"

namespace loopbench::harness {

struct LedgerItem {
  std::string where;      ///< "Table 1, N3", "Figure 5 a c e", "Equation 12"
  std::string statement;  ///< what the article states, with its numbers
  std::string ours;       ///< on the article's own input, the closed run
  std::string runs;       ///< over all runs of the sequence; empty if it does not depend on the run
  Verdict verdict = Verdict::cannot_be_judged;
};

/// Cells of the raw trajectory, one per run of this sequence; the closed run first.
std::vector<const PaperCell*> raw_runs(const std::vector<PaperCell>& cells,
                                       const std::string& sequence);

/// Tables 1 to 4: each row's change against ORB_SLAM2's row in the reading `text` at keyframes; the
/// levels of ORB_SLAM2's rows; rows that contradict themselves; the best N and M.
std::vector<LedgerItem> table_items(const std::vector<PaperCell>& cells);

/// Lengths, counts, speeds, segments and thresholds of the two datasets.
std::vector<LedgerItem> dataset_items(const std::vector<PaperCell>& cells);

/// Statements on equations that a computation can decide.
std::vector<LedgerItem> equation_items(const std::vector<PaperCell>& cells);

/// Printed coefficients, compared with the reference.
std::vector<LedgerItem> coefficient_items(const std::vector<PaperCell>& cells);

/// Figures 5 to 8: the curve and the N that fit best at a given speed and kappa; C1 at higher
/// speed.
///
/// The curves are fitted to the reference at the keyframes, in chord axes, so that errors are due
/// to the curve and not to drift. A candidate is a family at its own N: for each, all windows of N
/// consecutive keyframes whose speeds lie in the quoted range and that are a graph y' = f(x') are
/// fitted, and the rms distance to the reference between the keyframes is computed.
std::vector<LedgerItem> segment_items(const std::vector<PaperCell>& cells);

/// Claims on the complete trajectory in the reading `text`: level, areas, smoothness, cumulative
/// error, time, psi, and what the motion error depends on.
std::vector<LedgerItem> trajectory_items(const std::vector<PaperCell>& cells);

/// Level, areas, smoothness and cumulative error of the reading `guarded` and of the natural
/// spline.
std::vector<LedgerItem> own_reading_items(const std::vector<PaperCell>& cells);

/// A Markdown table.
std::string ledger_table(const std::vector<LedgerItem>& items);

/// The number of items per section and verdict, the rules of the verdicts, then all items under
/// headings.
std::string ledger(const std::vector<PaperCell>& cells);

}  // namespace loopbench::harness
