#include "methods/solvers/initial_values.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <deque>
#include <stdexcept>
#include <string>
#include <utility>

#include "datasets/core/closest_rotation.hpp"
#include "methods/solvers/block_cholesky.hpp"

namespace loopbench::methods {
namespace {

/// Edges of each keyframe, stored as one concatenated list.
struct Adjacency {
  struct Incidence {
    const Edge* edge;
    bool is_odometry;
  };
  std::vector<std::size_t> begin;
  std::vector<Incidence> incidences;

  explicit Adjacency(const Problem& problem) : begin(problem.keyframes.size() + 1, 0) {
    const auto visit_edges = [&](auto visit) {
      for (const Edge& edge : problem.odometry) visit(edge, true);
      for (const Edge& edge : problem.closures) visit(edge, false);
    };
    visit_edges([&](const Edge& edge, bool) {
      ++begin[edge.from + 1];
      ++begin[edge.to + 1];
    });
    for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
    incidences.resize(begin.back());
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    visit_edges([&](const Edge& edge, bool is_odometry) {
      incidences[next[edge.from]++] = {&edge, is_odometry};
      incidences[next[edge.to]++] = {&edge, is_odometry};
    });
  }
};

/// Traverses a spanning tree from keyframe 0, odometry before closures. Calls `visit` for each
/// reached keyframe with the edge that reached it; returns which keyframes were reached.
template <class Visit>
std::vector<bool> walk_tree(const Problem& problem, Visit visit) {
  const Adjacency graph(problem);
  std::vector<bool> reached(problem.keyframes.size(), false);
  struct Step {
    std::size_t to;
    std::size_t from;
    const Edge* edge;
  };
  std::deque<Step> queue{{0, 0, nullptr}};
  while (!queue.empty()) {
    const Step step = queue.front();
    queue.pop_front();
    if (reached[step.to]) continue;
    reached[step.to] = true;
    if (step.edge != nullptr) visit(*step.edge, step.from, step.to);
    for (std::size_t w = graph.begin[step.to]; w < graph.begin[step.to + 1]; ++w) {
      const auto& [edge, is_odometry] = graph.incidences[w];
      const std::size_t other = edge->from == step.to ? edge->to : edge->from;
      if (reached[other]) continue;
      if (is_odometry) {
        queue.push_front({other, step.to, edge});
      } else {
        queue.push_back({other, step.to, edge});
      }
    }
  }
  return reached;
}

struct Weights {
  double kappa;  ///< inverse mean variance of rotation [1/rad^2]
  double tau;    ///< inverse mean variance of translation [1/m^2]
};

Weights weights_of(const Edge& edge) {
  // The variances are the squared norms of the columns of L^-1. The inverse of the matrix would
  // take a fifth of the time of the chordal relaxation.
  const Eigen::LLT<Matrix6> factor(edge.information);
  Vector3 variances[2];
  for (int i = 0; i < 6; ++i) {
    const Twist column = factor.matrixL().solve(Twist::Unit(i));
    variances[i / 3][i % 3] = column.squaredNorm();
  }
  return {3.0 / variances[1].sum(), 3.0 / variances[0].sum()};
}

/// Normal equations whose unknowns are blocks of D rows for keyframes 1, 2, ..; keyframe 0 is
/// fixed.
template <int D>
class System {
 public:
  System(const EliminationStructure& structure, Eigen::Index columns)
      : factor_(structure), right_(Eigen::MatrixXd::Zero(D * structure.blocks(), columns)) {}

  /// Adds weight |x_to - M x_from - c|^2, where M is orthogonal (or 1) and x_0 = first.
  template <class Rows>
  void add(const Edge& edge,
           double weight,
           const Eigen::Matrix<double, D, D>& M,
           const Rows& c,
           const Rows& first) {
    const Eigen::Matrix<double, D, D> I = Eigen::Matrix<double, D, D>::Identity();
    const int i = static_cast<int>(edge.from) - 1;
    const int j = static_cast<int>(edge.to) - 1;  // never keyframe 0: from < to
    factor_.add(factor_.location(j, j), weight * I);
    right_.middleRows<D>(j * D) += weight * c;
    if (i < 0) {
      right_.middleRows<D>(j * D) += weight * (M * first);
      return;
    }
    factor_.add(factor_.location(i, i), weight * I);
    factor_.add(factor_.location(j, i), -weight * M);
    right_.middleRows<D>(i * D) -= weight * (M.transpose() * c);
  }

  const Eigen::MatrixXd& solve(const char* what) {
    if (!factor_.factorise()) {
      throw std::runtime_error(std::string("pose graph: the chordal relaxation of ") + what +
                               " is singular; all keyframes must be connected by edges");
    }
    factor_.solve(right_);
    return right_;
  }

 private:
  BlockCholesky<D> factor_;
  Eigen::MatrixXd right_;
};

struct ChordalEdges {
  explicit ChordalEdges(const Problem& problem) {
    for (const std::vector<Edge>* edges : {&problem.odometry, &problem.closures}) {
      for (const Edge& edge : *edges) all.emplace_back(&edge, weights_of(edge));
    }
  }
  template <class Visit>
  void for_each(Visit visit) const {
    for (const auto& [edge, weights] : all) visit(*edge, weights);
  }
  std::vector<std::pair<int, int>> pairs() const {
    std::vector<std::pair<int, int>> out;
    for_each([&](const Edge& edge, const Weights&) {
      if (edge.from == 0) return;
      out.emplace_back(static_cast<int>(edge.from) - 1, static_cast<int>(edge.to) - 1);
    });
    return out;
  }

  std::vector<std::pair<const Edge*, Weights>> all;
};

/// Relaxes the rotations about the z axis of keyframe 0 to (cos, sin).
void planar_rotations(const ChordalEdges& edges,
                      const EliminationStructure& structure,
                      std::vector<ScaledPose>& out) {
  System<2> rotations(structure, 1);
  edges.for_each([&](const Edge& edge, const Weights& w) {
    const Rotation& q = edge.from_from_to.rotation;
    const Eigen::Matrix2d M = Eigen::Rotation2Dd(2.0 * std::atan2(q.z(), q.w())).matrix();
    rotations.add<Eigen::Vector2d>(
        edge, w.kappa, M, Eigen::Vector2d::Zero(), Eigen::Vector2d::UnitX());
  });
  const Eigen::MatrixXd& directions = rotations.solve("rotations");
  for (std::size_t i = 1; i < out.size(); ++i) {
    const Eigen::Vector2d d = directions.middleRows<2>(2 * static_cast<Eigen::Index>(i - 1));
    out[i].pose.rotation = out[0].pose.rotation * exp_so3({0.0, 0.0, std::atan2(d.y(), d.x())});
  }
}

/// R_j = R_i Z is equivalent to R_j' = Z' R_i': the unknowns are the transposes, three rows per
/// keyframe.
void spatial_rotations(const ChordalEdges& edges,
                       const EliminationStructure& structure,
                       std::vector<ScaledPose>& out) {
  System<3> rotations(structure, 3);
  const Matrix3 first = out[0].pose.rotation.toRotationMatrix().transpose();
  edges.for_each([&](const Edge& edge, const Weights& w) {
    const Matrix3 inverse_rotation = edge.from_from_to.rotation.toRotationMatrix().transpose();
    rotations.add<Matrix3>(edge, w.kappa, inverse_rotation, Matrix3::Zero(), first);
  });
  const Eigen::MatrixXd& transposed = rotations.solve("rotations");
  for (std::size_t i = 1; i < out.size(); ++i) {
    const Matrix3 M = transposed.middleRows<3>(3 * static_cast<Eigen::Index>(i - 1)).transpose();
    out[i].pose.rotation = Rotation(closest_rotation(M)).normalized();
  }
}

}  // namespace

std::vector<ScaledPose> tree_values(const Problem& problem) {
  std::vector<ScaledPose> out;
  out.reserve(problem.keyframes.size());
  for (const StampedPose& k : problem.keyframes) out.push_back({k.world_from_body, 1.0});
  if (out.empty()) return out;
  walk_tree(problem, [&](const Edge& edge, std::size_t from, std::size_t to) {
    const ScaledPose step = edge.from == from ? measured(edge) : measured(edge).inverse();
    out[to] = normalized(out[from] * step);
  });
  return out;
}

std::optional<std::size_t> first_unconnected(const Problem& problem) {
  const std::size_t count = problem.keyframes.size();
  if (count == 0) return std::nullopt;
  std::size_t end = 1;  // of the chain from keyframe 0
  for (const Edge& edge : problem.odometry) end += edge.from + 1 == end && edge.to == end;
  if (end >= count) return std::nullopt;
  const std::vector<bool> reached =
      walk_tree(problem, [](const Edge&, std::size_t, std::size_t) {});
  for (std::size_t i = 0; i < reached.size(); ++i) {
    if (!reached[i]) return i;
  }
  return std::nullopt;
}

std::vector<ScaledPose> chordal_values(const Problem& problem,
                                       double scale_sigma,
                                       EliminationCache& cache) {
  const std::size_t n = problem.keyframes.size();
  std::vector<ScaledPose> out(n);
  if (n == 0) return out;
  out[0].pose = problem.keyframes[0].world_from_body;
  if (n == 1) return out;

  const ChordalEdges edges(problem);
  const EliminationStructure& structure = cache.of(static_cast<int>(n) - 1, edges.pairs());
  if (problem.planar) {
    planar_rotations(edges, structure, out);
  } else {
    spatial_rotations(edges, structure, out);
  }

  using Row = Eigen::RowVector3d;
  const Eigen::Matrix<double, 1, 1> one = Eigen::Matrix<double, 1, 1>::Identity();
  bool has_scale = false;
  edges.for_each([&](const Edge& edge, const Weights&) { has_scale |= edge.scale != 1.0; });
  if (has_scale) {
    System<1> scales(structure, 3);
    edges.for_each([&](const Edge& edge, const Weights&) {
      const double weight = scale_information(edge, scale_sigma);
      scales.add<Row>(edge, weight, one, Row(std::log(edge.scale), 0.0, 0.0), Row::Zero());
    });
    const Eigen::MatrixXd& logs = scales.solve("scales");
    for (std::size_t i = 1; i < n; ++i) {
      out[i].scale = std::exp(logs(static_cast<Eigen::Index>(i - 1), 0));
    }
  }

  System<1> translations(structure, 3);
  edges.for_each([&](const Edge& edge, const Weights& w) {
    const ScaledPose& from = out[edge.from];
    const Vector3 step = from.scale * (from.pose.rotation * edge.from_from_to.translation);
    // The deviations of a measurement are in the scale of its first keyframe.
    const double weight = w.tau / (from.scale * from.scale);
    translations.add<Row>(edge, weight, one, step.transpose(), out[0].pose.translation.transpose());
  });
  const Eigen::MatrixXd& positions = translations.solve("positions");
  for (std::size_t i = 1; i < n; ++i) {
    out[i].pose.translation = positions.row(static_cast<Eigen::Index>(i - 1)).transpose();
  }
  return out;
}

}  // namespace loopbench::methods
