#include "methods/solvers/incremental_smoother.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "methods/solvers/edge_residual.hpp"
#include "methods/solvers/elimination_tree.hpp"
#include "methods/solvers/graduated_loss.hpp"
#include "methods/solvers/groups/se2.hpp"
#include "methods/solvers/groups/se3.hpp"
#include "methods/solvers/index_set.hpp"

namespace loopbench::methods {
namespace {

template <class G>
class IncrementalSmoother final : public Incremental {
 public:
  explicit IncrementalSmoother(const IncrementalSettings& settings) : settings_(settings) {}

  Trajectory update(const Increment& added, Report& report) override {
    for (const StampedPose& keyframe : added.keyframes) add_keyframe(keyframe);
    for (const Edge& edge : added.odometry) add_edge(edge, true);
    const std::size_t before = tree_.eliminations();
    iterations_ = 0;
    for (const Edge& edge : added.closures) add_closure(edge);
    for (const Edge& edge : added.withdrawn) remove_edge(edge);
    optimise();
    unsolved_ = 0.0;
    if (is(IncrementalRobustness::graduated) && !added.closures.empty()) harden();
    report.count("iterations", iterations_);
    if (is(IncrementalRobustness::gate)) report.count("closures_kept", static_cast<double>(kept_));
    report.count("eliminations", static_cast<double>(tree_.eliminations() - before));
    if (!touched_.empty()) report.notes.push_back("stopped at max_iterations before the tolerance");
    return poses_;
  }

 private:
  using Element = typename G::Element;
  struct Constraint {
    Edge edge;
    Element to_from_measured_from;
    typename G::Square information;
    bool is_odometry = true;
    bool is_removed = false;
    double cost = 0.0;    ///< its part of cost_
    double chi2 = 0.0;    ///< its part of chi2_
    double mu = 0.0;      ///< `graduated`: 0, the loss is convex, to 1
    double start = 0.0;   ///< mu at the next decision
    double weight = 1.0;  ///< of the information
  };
  static constexpr double kQuantile = G::kDof == 3 ? 11.345 : 16.812;  // of chi2, 99 %

  bool is(IncrementalRobustness robust) const { return settings_.robust == robust; }

  void add_closure(const Edge& edge) {
    if (!is(IncrementalRobustness::gate)) return add_edge(edge, false);
    if (add_if_harmless(edge)) return;
    if (unsolved_ > 0.0) {  // otherwise the poses are a solution: new odometry does not change them
      optimise();
      unsolved_ = 0.0;
      if (add_if_harmless(edge)) return;
    }
    const double before = chi2_;
    const std::vector<Element> at = at_;
    const std::vector<Element> now = now_;
    add_edge(edge, false);
    optimise();
    if (chi2_ - before <= kQuantile) return;
    // Back to the former solution: a false closure can lead to another minimum.
    remove_edge(edge);
    for (const std::size_t pose : moved_.list()) {
      at_[pose] = at[pose];
      set_estimate(pose, now[pose]);
    }
    relinearise_edges(moved_.list());
    update_chi2_of_moved();
  }

  /// Adds the closure if the gate accepts it in any case: the minimum of chi2 is at most its value
  /// at the present poses, so that it rises by at most what the closures since the last solution
  /// cost there.
  bool add_if_harmless(const Edge& edge) {
    const double chi2 = chi2_of(constraint(edge, false));
    if (unsolved_ + chi2 > kQuantile) return false;
    unsolved_ += chi2;
    add_edge(edge, false);
    return true;
  }

  /// Updates the factorisation until no correction exceeds the tolerance, or another linearisation
  /// is not worth its time.
  void optimise() {
    moved_.clear();
    double last_decrease = 0.0;
    for (int i = 0; i < settings_.max_iterations && !touched_.empty(); ++i) {
      ++iterations_;
      const std::vector<std::size_t> touched = std::exchange(touched_, {});
      const std::vector<std::size_t> solved =
          tree_.update(touched, graph_, std::exchange(has_new_edges_, false));
      for (const std::size_t pose : solved) {
        set_estimate(pose, G::compose(at_[pose], G::exp(tree_.correction(pose))));
      }
      if (!is(IncrementalRobustness::none)) {
        for (const std::size_t pose : touched) moved_.insert(pose);
        for (const std::size_t pose : solved) moved_.insert(pose);
      }
      if (is(IncrementalRobustness::graduated)) {
        for (const std::size_t pose : solved) {
          for (const std::size_t edge : graph_.edges_of[pose]) reweigh(edge);
        }
      }
      // Gauss-Newton converges linearly: the next decrease is to this one as this one to the last.
      const double decrease = tree_.decrease();
      const double next_decrease =
          last_decrease > 0.0 ? decrease * decrease / last_decrease : decrease;
      if (i > 0 && touched_.empty() && next_decrease <= settings_.decrease * cost_) break;
      last_decrease = decrease;
      relinearise(solved);
    }
    if (is(IncrementalRobustness::gate)) update_chi2_of_moved();
  }

  /// Decides about the new closures, and again about those of all poses that these moved: their
  /// loss is convex at first, except for those that were rejected before, which start nearer to 1.
  void harden() {
    constexpr int kSteps = 5;  // of next_mu() from 0 to 1
    std::set<std::size_t> open;
    for (const std::size_t pose : moved_.list()) {
      for (const std::size_t edge : graph_.edges_of[pose]) {
        if (!constraints_[edge].is_odometry) open.insert(edge);
      }
    }
    for (const std::size_t edge : open) constraints_[edge].mu = constraints_[edge].start;
    for (int step = 0; step < kSteps; ++step) {
      for (const std::size_t edge : open) reweigh(edge);
      optimise();
      for (const std::size_t edge : open) constraints_[edge].mu = next_mu(constraints_[edge].mu);
    }
    for (const std::size_t edge : open) {
      Constraint& of = constraints_[edge];
      const double chi2 = chi2_of(of);
      if (chi2 > kQuantile) of.start = next_mu(of.start);
      if (chi2 < G::kDof) of.start = std::max(0.0, of.start - 0.1);
    }
  }

  void reweigh(std::size_t index) {
    constexpr double kSame = 1e-3;  // change of a weight that is not worth an elimination
    Constraint& of = constraints_[index];
    if (of.is_odometry || of.is_removed) return;
    const double weight = graduated_weight(chi2_of(of), kQuantile, of.mu);
    if (std::abs(weight - of.weight) <= kSame * of.weight) return;
    of.weight = weight;
    linearise(index);
    touched_.push_back(of.edge.from);
    touched_.push_back(of.edge.to);
  }

  double chi2_of(const Constraint& of) const {
    const typename G::Tangent e = group_edge_error<G>(
        of.to_from_measured_from, G::compose(G::inverse(now_[of.edge.from]), now_[of.edge.to]));
    return e.dot(of.information * e);
  }

  void update_chi2_of_moved() {
    for (const std::size_t pose : moved_.list()) {
      for (const std::size_t edge : graph_.edges_of[pose]) {
        Constraint& of = constraints_[edge];
        if (pose == of.edge.to && moved_.contains(of.edge.from)) continue;  // from there
        const double chi2 = chi2_of(of);
        chi2_ += chi2 - std::exchange(of.chi2, chi2);
      }
    }
  }

  void add_keyframe(const StampedPose& keyframe) {
    if (poses_.empty()) world_from_first_ = keyframe.world_from_body;
    poses_.push_back(keyframe);
    at_.push_back(Element{});
    now_.push_back(Element{});
    graph_.edges_of.emplace_back();
    moved_.add_index();
    tree_.add_pose();
  }

  static Constraint constraint(const Edge& edge, bool is_odometry) {
    const Element measured = G::from(ScaledPose{edge.from_from_to, 1.0});
    return {edge, G::inverse(measured), G::information(edge, 1.0), is_odometry};
  }

  void add_edge(const Edge& edge, bool is_odometry) {
    if (is_odometry) {
      const Element measured = G::from(ScaledPose{edge.from_from_to, 1.0});
      set_estimate(edge.to, G::compose(now_[edge.from], measured));
      at_[edge.to] = now_[edge.to];
    }
    if (!is_odometry) ++kept_;
    const std::size_t index = constraints_.size();
    constraints_.push_back(constraint(edge, is_odometry));
    graph_.equations.push_back({edge.from, edge.to, {}});
    linearised_.add_index();
    has_new_edges_ = true;
    linearise(index);
    for (const std::size_t end : {edge.from, edge.to}) {
      graph_.edges_of[end].push_back(index);
      touched_.push_back(end);
    }
  }

  void remove_edge(const Edge& edge) {
    const auto is_it = [&](std::size_t index) {
      return is_same_measurement(constraints_[index].edge, edge);
    };
    const auto found = std::ranges::find_if(graph_.edges_of[edge.to], is_it);
    if (found == graph_.edges_of[edge.to].end()) return;
    const std::size_t index = *found;
    constraints_[index].is_removed = true;
    cost_ -= constraints_[index].cost;
    chi2_ -= constraints_[index].chi2;
    --kept_;
    for (const std::size_t end : {edge.from, edge.to}) {
      std::erase(graph_.edges_of[end], index);
      touched_.push_back(end);
    }
  }

  void set_estimate(std::size_t i, const Element& now) {
    now_[i] = now;
    poses_[i].world_from_body = normalized(world_from_first_ * G::to_scaled_pose(now).pose);
  }

  void linearise(std::size_t index) {
    Constraint& of = constraints_[index];
    const EdgeResidual<G> residual =
        edge_residual<G>(of.to_from_measured_from, at_[of.edge.from], at_[of.edge.to]);
    const double cost = of.weight * residual.error.dot(of.information * residual.error);
    cost_ += cost - std::exchange(of.cost, cost);
    Eigen::Matrix<double, G::kDof, 2 * G::kDof + 1> jacobian;
    jacobian << residual.by_from, residual.by_to, -residual.error;
    graph_.equations[index].matrix = jacobian.template leftCols<2 * G::kDof>().transpose() *
                                     (of.weight * (of.information * jacobian));
  }

  /// Moves the points of linearisation whose corrections exceed the tolerance.
  void relinearise(const std::vector<std::size_t>& solved) {
    std::vector<std::size_t> moved;
    for (const std::size_t i : solved) {
      if (tree_.correction(i).cwiseAbs().maxCoeff() <= settings_.tolerance) continue;
      at_[i] = now_[i];
      moved.push_back(i);
    }
    relinearise_edges(moved);
  }

  /// Linearises the edges at these poses and touches their ends.
  void relinearise_edges(const std::vector<std::size_t>& poses) {
    linearised_.clear();
    for (const std::size_t i : poses) {
      for (const std::size_t edge : graph_.edges_of[i]) linearised_.insert(edge);
    }
    for (const std::size_t edge : linearised_.list()) {
      linearise(edge);
      touched_.push_back(constraints_[edge].edge.from);
      touched_.push_back(constraints_[edge].edge.to);
    }
  }

  IncrementalSettings settings_;
  Pose world_from_first_;
  Trajectory poses_;
  std::vector<Element> at_;           ///< points of linearisation, first_from_body
  std::vector<Element> now_;          ///< estimate: at_ and its correction
  std::vector<std::size_t> touched_;  ///< poses to eliminate again in the next iteration
  std::vector<Constraint> constraints_;
  typename EliminationTree<G::kDof>::Graph graph_;  ///< edge k: constraint k
  EliminationTree<G::kDof> tree_;
  IndexSet linearised_;         ///< edges, by the last relinearisation
  bool has_new_edges_ = false;  ///< since the last elimination
  int iterations_ = 0;          ///< of the current update
  double cost_ = 0.0;           ///< at the points of linearisation
  double chi2_ = 0.0;           ///< at the estimate, kept up to date for `gate`
  double unsolved_ = 0.0;       ///< chi2 of closures since the last solution, for `gate`
  IndexSet moved_;              ///< poses, by the last optimise()
  std::size_t kept_ = 0;        ///< closures
};

}  // namespace

std::unique_ptr<Incremental> incremental_smoother(bool planar,
                                                  const IncrementalSettings& settings) {
  if (planar) return std::make_unique<IncrementalSmoother<Se2>>(settings);
  return std::make_unique<IncrementalSmoother<Se3>>(settings);
}

}  // namespace loopbench::methods
