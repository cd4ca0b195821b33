#include "metrics/body_offset.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace loopbench {
namespace {

constexpr std::size_t kFewest = 20;   // stretches
constexpr double kExplains = 0.5;     // of the squares, to be believed
constexpr double kLeastTurn = 5.0;    // [deg]: less is a tilt that planar odometry cannot see
constexpr double kHardlyTold = 0.02;  // of the best told direction's information
constexpr double kRounding = 1e-9;    // of the motion: nothing is left to explain
constexpr double kDegree = std::numbers::pi / 180.0;

/// How both moved over the same time.
struct TurningStretch {
  Pose reference;
  Pose estimate;
};

std::vector<TurningStretch> turning_stretches(const Trajectory& reference,
                                              const Trajectory& estimate,
                                              const BodyOffsetOptions& o) {
  const double cosine = std::cos(0.5 * o.turn * kDegree);
  std::vector<TurningStretch> out;
  std::size_t begin = 0;
  for (std::size_t i = 1; i < estimate.size(); ++i) {
    const Pose& from = estimate[begin].world_from_body;
    const Pose& to = estimate[i].world_from_body;
    const bool turned = std::abs(from.rotation.dot(to.rotation)) <= cosine;
    if (turned) {
      out.push_back({reference[begin].world_from_body.inverse() * reference[i].world_from_body,
                     from.inverse() * to});
    }
    if (turned || estimate[i].stamp - estimate[begin].stamp > o.longest) begin = i;
  }
  return out;
}

/// Turns and displacements, each in parts of their own size.
struct MotionSizes {
  double turns = 0.0;
  double ways = 0.0;
};

MotionSizes sizes_of(const std::vector<TurningStretch>& stretches) {
  MotionSizes out;
  for (const auto& [q, z] : stretches) {
    out.turns += log_so3(z.rotation).squaredNorm();
    out.ways += q.translation.squaredNorm() + z.translation.squaredNorm();
  }
  return out;
}

double difference(const std::vector<TurningStretch>& stretches,
                  const MotionSizes& sizes,
                  const Rotation& turn) {
  double out = 0.0;
  for (const auto& [q, z] : stretches) {
    out += (log_so3(z.rotation) - turn * log_so3(q.rotation)).squaredNorm() / sizes.turns;
    if (sizes.ways > 0.0) out += (z.translation - turn * q.translation).squaredNorm() / sizes.ways;
  }
  return out;
}

/// The turn of most likely matches (Kabsch).
Rotation turn_of(const Eigen::JacobiSVD<Matrix3>& svd) {
  Matrix3 flip = Matrix3::Identity();
  flip(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  Rotation turn(Matrix3(svd.matrixU() * flip * svd.matrixV().transpose()));
  if (turn.w() < 0.0) turn.coeffs() *= -1.0;  // the same turn, in the form that files have
  return turn.normalized();
}

Rotation best_turn(const std::vector<TurningStretch>& stretches, const MotionSizes& sizes) {
  Matrix3 turns = Matrix3::Zero();
  Matrix3 ways = Matrix3::Zero();
  for (const auto& [q, z] : stretches) {
    turns += log_so3(z.rotation) * log_so3(q.rotation).transpose() / sizes.turns;
    if (sizes.ways > 0.0) ways += z.translation * q.translation.transpose() / sizes.ways;
  }
  constexpr unsigned kWhole = Eigen::ComputeFullU | Eigen::ComputeFullV;
  Eigen::JacobiSVD<Matrix3> svd(turns, kWhole);
  // Displacements depend on the place sought, too: they only help where all turn about one axis.
  const bool about_one_axis = svd.singularValues()[1] <= kHardlyTold * svd.singularValues()[0];
  if (about_one_axis) svd.compute(turns + ways, kWhole);
  const Rotation turn = turn_of(svd);
  const double before = difference(stretches, sizes, Rotation::Identity());
  const double after = difference(stretches, sizes, turn);
  const bool differs =
      before > kRounding * kRounding && log_so3(turn).norm() >= kLeastTurn * kDegree;
  return differs && after <= (1.0 - kExplains) * before ? turn : Rotation(Rotation::Identity());
}

/// (R_Z - I) c = R_C t_Q - t_Z, a stretch each. Only how stretches differ from their mean counts:
/// where all turn one way, steady drift looks like another place.
struct LeverEquations {
  std::vector<Matrix3> turned;  ///< R_Z - I
  std::vector<Vector3> moved;   ///< R_C t_Q - t_Z
  std::vector<double> weights;

  void centre() {
    double sum = 0.0;
    Matrix3 turned_mean = Matrix3::Zero();
    Vector3 moved_mean = Vector3::Zero();
    for (std::size_t k = 0; k < weights.size(); ++k) {
      sum += weights[k];
      turned_mean += weights[k] * turned[k];
      moved_mean += weights[k] * moved[k];
    }
    for (Matrix3& each : turned) each -= turned_mean / sum;
    for (Vector3& each : moved) each -= moved_mean / sum;
  }
};

/// Least squares in the directions that are told well enough; their standard deviations at one
/// unit of residual.
Vector3 weighted_lever(const LeverEquations& e, Vector3& deviation) {
  Matrix3 information = Matrix3::Zero();
  Vector3 right = Vector3::Zero();
  for (std::size_t k = 0; k < e.turned.size(); ++k) {
    information += e.weights[k] * e.turned[k].transpose() * e.turned[k];
    right += e.weights[k] * e.turned[k].transpose() * e.moved[k];
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3> axes(information);
  Vector3 lever = Vector3::Zero();
  Vector3 variance = Vector3::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double told = axes.eigenvalues()[i];
    const auto most = static_cast<double>(e.turned.size());
    if (told <= kHardlyTold * axes.eigenvalues()[2] || told <= kRounding * most) continue;
    const Vector3 axis = axes.eigenvectors().col(i);
    lever += axis.dot(right) / told * axis;
    variance += axis.cwiseAbs2() / told;
  }
  deviation = variance.cwiseSqrt();
  return lever;
}

/// Robustly; returns the weights it ends with.
std::vector<double> fit_lever(LeverEquations e, BodyOffset& out) {
  constexpr int kRounds = 20;
  constexpr double kHuber = 2.0;        // times the residuals' scale
  constexpr double kMedianOf3d = 1.54;  // of a standard normal vector's length
  const std::size_t size = e.turned.size();
  std::vector<double> lengths(size);
  Vector3 lever, unit;
  for (int round = 0; round < kRounds; ++round) {
    e.centre();
    lever = weighted_lever(e, unit);
    for (std::size_t k = 0; k < size; ++k) lengths[k] = (e.moved[k] - e.turned[k] * lever).norm();
    std::vector<double> sorted = lengths;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(size / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    const double enough = kHuber * *middle / kMedianOf3d;
    for (std::size_t k = 0; k < size; ++k) {
      e.weights[k] = lengths[k] > enough && enough > 0.0 ? enough / lengths[k] : 1.0;
    }
  }
  double left = 0.0;
  for (std::size_t k = 0; k < size; ++k) left += e.weights[k] * lengths[k] * lengths[k];
  out.body_from_reference.translation = lever;
  out.deviation = unit * std::sqrt(left / (3.0 * static_cast<double>(size)));
  return e.weights;
}

}  // namespace

std::optional<BodyOffset> body_offset(const Trajectory& reference,
                                      const Trajectory& estimate,
                                      const BodyOffsetOptions& options) {
  const std::vector<TurningStretch> stretches = turning_stretches(reference, estimate, options);
  if (stretches.size() < kFewest) return std::nullopt;
  BodyOffset out;
  out.stretches = stretches.size();
  const MotionSizes sizes = sizes_of(stretches);
  const Rotation turn = best_turn(stretches, sizes);
  out.body_from_reference.rotation = turn;
  LeverEquations e;
  for (const auto& [q, z] : stretches) {
    e.turned.push_back(z.rotation.toRotationMatrix() - Matrix3::Identity());
    e.moved.push_back(turn * q.translation - z.translation);
    e.weights.push_back(1.0);
  }
  const std::vector<double> weights = fit_lever(e, out);
  // Of the mean stretch, too, which had no say in where.
  double before = 0.0, after = 0.0;
  for (std::size_t k = 0; k < stretches.size(); ++k) {
    const auto& [q, z] = stretches[k];
    const Vector3 left = e.moved[k] - e.turned[k] * out.body_from_reference.translation;
    before += weights[k] * (q.translation - z.translation).squaredNorm();
    after += weights[k] * left.squaredNorm();
  }
  if (before > kRounding * kRounding * sizes.ways) out.explained = 1.0 - after / before;
  return out;
}

std::optional<BodyOffset> body_offset(const Evaluation& evaluation,
                                      const BodyOffsetOptions& options) {
  const bool is_flat = evaluation.protocol.project != Plane::none;
  if (is_flat || !why_no_attitude(evaluation).empty()) return std::nullopt;
  return body_offset(evaluation.reference, evaluation.estimate, options);
}

std::string other_body(const BodyOffset& offset) {
  if (offset.explained < kExplains) return "";
  const auto& [rotation, at] = offset.body_from_reference;
  std::string place;
  const auto put = [&](double value, double parts) {
    place += (place.empty() ? "" : ",") + to_text(std::round(value * parts) / parts + 0.0);
  };
  for (const double value : at) put(value, 1e3);
  if (rotation.vec().norm() > 0.0) {
    for (const double value : rotation.coeffs()) put(value, 1e5);
  }
  return "the reference seems to follow another body, at " + place +
         " of the estimate's: that explains " +
         std::to_string(std::lround(100.0 * offset.explained)) +
         " % of how differently they move in turns";
}

std::vector<Score> body_offset_scores(const Evaluation& evaluation,
                                      const BodyOffsetOptions& options) {
  const auto found = body_offset(evaluation, options);
  if (!found) throw Undefined("too little turns, or attitudes or whole positions are missing");
  const auto& [rotation, at] = found->body_from_reference;
  return {single("position", "x", "m", at.x()),
          single("position", "y", "m", at.y()),
          single("position", "z", "m", at.z()),
          single("turn", "", "deg", log_so3(rotation).norm() / kDegree),
          single("explained", "", "%", 100.0 * found->explained)};
}

}  // namespace loopbench
