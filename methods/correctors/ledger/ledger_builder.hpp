/// Computes the ledger of one problem (closure_ledger.hpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/core/closure_parts.hpp"
#include "datasets/core/closure_places.hpp"
#include "methods/correctors/consensus/anchor_judgement.hpp"
#include "methods/correctors/ledger/ledger_verdict.hpp"
#include "methods/correctors/ledger/odometry_errors.hpp"
#include "methods/correctors/ledger/solution.hpp"
#include "methods/correctors/stiffness.hpp"
#include "methods/solvers/initial_values.hpp"
#include "methods/solvers/left_out_parts.hpp"

namespace loopbench::methods {

using ClosureParts = std::vector<std::vector<std::size_t>>;

/// A problem, its minimum, and what its closures are without some of them.
template <class G>
struct Linearised {
  Problem problem;
  LedgerSolution at;
  GraphInverse<G> inverse;
  LeftOutParts<G> left_out;

  Linearised(Problem of, const typename GraphInverse<G>::Pairs& pairs)
      : problem(std::move(of)),
        at(ledger_solution(problem)),
        inverse(at.poses, problem, at.settings, pairs),
        left_out(at.poses, problem, inverse) {}
};

template <class G>
class LedgerBuilder {
 public:
  LedgerBuilder(const Problem& problem, const LedgerSettings& settings)
      : settings_(settings), problem_(with_bounded_stiffness(problem)) {}

  ClosureLedger run() {
    if (problem_.closures.empty()) {
      out_.why_unknown = "the problem has no loop closures";
      out_.anchors = use_agreeing_anchors();
      return std::move(out_);
    }
    const OdometryRuns runs(problem_);
    const auto odometry = odometry_errors<G>(problem_, runs);
    for (std::size_t k = 0; k < problem_.closures.size(); ++k) {
      out_.rows.push_back({.loop_length = runs.length(problem_.closures[k])});
      out_.rows.back().in_odometry = odometry[k];
    }
    settings_.progress("judging " + std::to_string(out_.rows.size()) + " closures");
    add_judgement(problem_, out_);
    out_.verdict = verdict_of(out_);
    auto anchors = use_agreeing_anchors();
    set_places();
    settings_.progress("solving with all closures");
    const bool is_split = out_.verdict == LedgerVerdict::disagrees;
    Linearised<G> all(problem_, is_split ? Pairs{} : pairs_within(problem_.closures, parts_));
    add_drops(all);
    rank_suspects(out_);
    add_moves(all);
    if (is_split) {
      add_predictions_of_others();
    } else {
      add_predictions(all, parts_, all_closures());
    }
    summarise();
    if (is_contradicted(out_.verdict)) solve_without_suspects(all.at);
    out_.anchors = std::move(anchors);
    return std::move(out_);
  }

 private:
  using Pairs = typename GraphInverse<G>::Pairs;

  std::vector<std::size_t> all_closures() const {
    std::vector<std::size_t> out(out_.rows.size());
    std::iota(out.begin(), out.end(), std::size_t{0});
    return out;
  }

  bool is_large() const { return out_.rows.size() > 2000; }

  /// The pairs within a part fill the factor, so that parts are smaller if there are many.
  PartSize part_size() const { return {.closures = is_large() ? 8UL : 24UL}; }

  /// Removes the anchors that do not agree, so that they are in no solution.
  std::optional<consensus::AnchorJudgement> use_agreeing_anchors() {
    if (problem_.anchors.empty()) return std::nullopt;
    settings_.progress("judging " + std::to_string(problem_.anchors.size()) + " anchors");
    const ClosureJudgement closures = out_.judgement.value_or(ClosureJudgement{});
    consensus::AnchorJudgement found = consensus::judge_anchors(problem_, closures);
    problem_.anchors = consensus::used_anchors(problem_.anchors, found);
    return found;
  }

  void set_places() {
    parts_ = closure_parts(problem_.closures, part_size());
    out_.places = parts_.size();
    out_.covered = covered_share(problem_, parts_);
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      for (const std::size_t k : parts_[p]) out_.rows[k].place = p;
    }
  }

  void add_drops(const Linearised<G>& all) {
    for (std::size_t k = 0; k < out_.rows.size(); ++k) {
      const auto alone = all.left_out.without({k});
      if (!alone.empty()) out_.rows[k].cost_drop = all.left_out.cost_drop(k, alone.front());
    }
  }

  void add_moves(Linearised<G>& all) {
    constexpr std::size_t kShown = 20;
    const std::size_t count = out_.rows.size();
    const bool has_all = count * problem_.keyframes.size() <= settings_.all_moves;
    for (std::size_t i = 0; i < (has_all ? count : std::min(count, kShown)); ++i) {
      const std::size_t k = out_.suspects[i];
      const auto alone = all.left_out.without({k});
      if (alone.empty()) continue;
      Eigen::MatrixXd change = all.left_out.force(k, alone.front(), all.at.poses.size());
      all.inverse.solve(change);
      out_.rows[k].moves = moves_of(all.at.poses.size(), [&](std::size_t j) -> double {
        const auto row = static_cast<Eigen::Index>(j) * G::kDof;
        return change.col(0).segment < G::kDof == 3 ? 2 : 3 > (row).norm();
      });
    }
  }

  template <class Distance>
  static Moves moves_of(std::size_t poses, Distance distance) {
    Moves out;
    double sum = 0.0;
    for (std::size_t i = 0; i < poses; ++i) {
      const double metres = distance(i);
      sum += metres * metres;
      if (metres > out.max) out.max = metres, out.at = i;
    }
    out.rms = std::sqrt(sum / static_cast<double>(poses));
    return out;
  }

  /// `index`: of each closure of the linearised problem in the whole one; `parts`: of the former. A
  /// single part is predicted by the odometry alone, which its rows have.
  void add_predictions(const Linearised<G>& from,
                       const ClosureParts& parts,
                       const std::vector<std::size_t>& index) {
    if (parts.size() < 2 && from.problem.anchors.empty()) return;
    for (const std::vector<std::size_t>& part : parts) {
      const std::vector<LeftOut<G>> without = from.left_out.without(part);
      for (std::size_t i = 0; i < without.size(); ++i) {
        out_.rows[index[part[i]]].predicted =
            closure_error<G>(without[i].error, without[i].covariance);
      }
    }
  }

  /// Predictions by the closures that agree: of these without their place, of the others by all.
  void add_predictions_of_others() {
    settings_.progress("solving with the closures that agree");
    std::vector<std::size_t> index, others;
    for (std::size_t k = 0; k < out_.rows.size(); ++k) {
      (out_.finding(k) == ClosureFinding::agrees ? index : others).push_back(k);
    }
    Problem trusted = with_bounded_stiffness(trusted_problem(problem_, out_));
    const ClosureParts parts = closure_parts(trusted.closures, part_size());
    Pairs pairs = pairs_within(trusted.closures, parts);
    for (const std::size_t k : others) {
      pairs.emplace_back(problem_.closures[k].from, problem_.closures[k].to);
    }
    const Linearised<G> from(std::move(trusted), pairs);
    add_predictions(from, parts, index);
    for (const std::size_t k : others) {
      out_.rows[k].predicted = error_at(from.at.poses, problem_.closures[k], from.inverse);
      out_.rows[k].is_prediction_solved = true;
    }
  }

  /// Error of a closure that the solution does not use.
  static ClosureError error_at(const std::vector<ScaledPose>& poses,
                               const Edge& closure,
                               const GraphInverse<G>& inverse) {
    const ScaledPose first_from_world = poses.front().inverse();
    const EdgeResidual<G> at = edge_residual<G>(G::inverse(G::from(measured(closure))),
                                                G::from(first_from_world * poses[closure.from]),
                                                G::from(first_from_world * poses[closure.to]));
    using Square = typename G::Square;
    const auto part = [&](const Square& left, std::size_t i, const Square& right, std::size_t j) {
      return Square(left * inverse.covariance(i, j) * right.transpose());
    };
    const Square cross = part(at.by_from, closure.from, at.by_to, closure.to);
    const Square covariance = part(at.by_from, closure.from, at.by_from, closure.from) +
                              part(at.by_to, closure.to, at.by_to, closure.to) + cross +
                              cross.transpose() + inverse_of(G::information(closure, 1.0));
    return closure_error<G>(at.error, covariance);
  }

  void summarise() {
    ClosureParts checked;
    for (const std::vector<std::size_t>& part : parts_) {
      std::vector<std::size_t> members;
      for (const std::size_t k : part) {
        const LedgerRow& row = out_.rows[k];
        const bool is_dropped =
            out_.verdict == LedgerVerdict::disagrees && out_.finding(k) != ClosureFinding::agrees;
        if (row.predicted && row.in_odometry && !is_dropped) members.push_back(k);
      }
      if (!members.empty()) checked.push_back(std::move(members));
    }
    if (checked.size() < 2) return;
    const auto [ratio, better] = place_prediction(
        checked,
        [&](std::size_t k) { return out_.rows[k].predicted->metres; },
        [&](std::size_t k) { return out_.rows[k].in_odometry->metres; });
    out_.ratio = ratio;
    out_.better_places = better;
    out_.helps = do_help(out_);
  }

  /// Replaces the numbers of the first suspects by those of solutions without them.
  void solve_without_suspects(const LedgerSolution& all) {
    const std::size_t most =
        is_large() ? std::min<std::size_t>(1, settings_.named) : settings_.named;
    for (const std::size_t k : out_.suspects) {
      if (out_.named == most) return;
      const bool is_named =
          out_.verdict != LedgerVerdict::disagrees || out_.finding(k) != ClosureFinding::agrees;
      if (!is_named) return;
      ++out_.named;
      const Problem rest = without_closures(problem_, {k});
      if (rest.closures.empty() && rest.anchors.empty()) {
        solve_by_odometry(k, all);
        continue;
      }
      if (first_unconnected(rest)) continue;
      settings_.progress("solving without closure " + std::to_string(out_.named) + " of at most " +
                         std::to_string(most));
      const LedgerSolution without = ledger_solution(rest);
      set_change(k, all, without);
      if (out_.rows[k].is_prediction_solved) continue;
      const std::vector<std::size_t>& part = parts_[out_.rows[k].place];
      set_prediction(k, part, without);
    }
  }

  /// Without its only closure, a chain is its odometry.
  void solve_by_odometry(std::size_t k, const LedgerSolution& all) {
    LedgerSolution without{tree_values(without_closures(problem_, {k})), 0.0, all.settings};
    set_change(k, all, without);
  }

  void set_change(std::size_t k, const LedgerSolution& all, const LedgerSolution& without) {
    LedgerRow& row = out_.rows[k];
    row.cost_drop = all.chi2 - without.chi2;
    row.moves = moves_of(all.poses.size(), [&](std::size_t i) {
      return (all.poses[i].pose.translation - without.poses[i].pose.translation).norm();
    });
    row.is_drop_solved = true;
  }

  void set_prediction(std::size_t k,
                      const std::vector<std::size_t>& part,
                      const LedgerSolution& without) {
    if (!out_.rows[k].predicted) return;
    const Problem rest = without_closures(problem_, part);
    if (rest.closures.empty() && rest.anchors.empty()) return;
    const LedgerSolution at = part.size() == 1 ? without : ledger_solution(rest);
    const Edge& closure = problem_.closures[k];
    const GraphInverse<G> inverse(at.poses, rest, at.settings, {{closure.from, closure.to}});
    out_.rows[k].predicted = error_at(at.poses, closure, inverse);
    out_.rows[k].is_prediction_solved = true;
  }

  const LedgerSettings& settings_;
  Problem problem_;
  ClosureParts parts_;
  ClosureLedger out_;
};

}  // namespace loopbench::methods
