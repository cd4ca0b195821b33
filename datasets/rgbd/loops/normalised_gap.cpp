#include "datasets/rgbd/loops/normalised_gap.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace loopbench {
namespace {

constexpr double kMedianOfSix = 5.348 / 6.0;  // of chi^2 with six degrees, over six

Matrix6 carried(const Pose& by, const Matrix6& covariance) {
  const Matrix6 A = adjoint(by);
  return A * covariance * A.transpose();
}

double excess_of(std::vector<double> gaps, std::size_t fewest) {
  if (gaps.empty() || gaps.size() < fewest) return 1.0;
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
  std::nth_element(gaps.begin(), middle, gaps.end());
  return *middle / kMedianOfSix;
}

}  // namespace

std::vector<double> normalised_gaps(const std::vector<Edge>& odometry,
                                    const std::vector<Edge>& closures) {
  // chain[k] is keyframe k in the first one's frame; spent[k] the covariance up to it, as a twist
  // of the first frame, so that a stretch's is the difference of two.
  std::vector<Pose> chain{Pose{Rotation::Identity(), Vector3::Zero()}};
  std::vector<Matrix6> spent{Matrix6::Zero()};
  for (const Edge& edge : odometry) {
    chain.push_back(normalized(chain.back() * edge.from_from_to));
    spent.push_back(spent.back() + carried(chain.back(), edge.information.inverse()));
  }
  std::vector<double> out;
  for (const Edge& loop : closures) {
    const Pose way = chain[loop.from].inverse() * chain[loop.to];
    const Pose gap = loop.from_from_to.inverse() * way;
    const Twist c = log_se3(gap);
    const Matrix6 of_way = carried(chain[loop.to].inverse(), spent[loop.to] - spent[loop.from]);
    const Matrix6 S = of_way + carried(gap.inverse(), loop.information.inverse());
    out.push_back(c.dot(S.ldlt().solve(c)) / 6.0);
  }
  return out;
}

double information_excess(const std::vector<Edge>& odometry,
                          const std::vector<Edge>& closures,
                          std::size_t fewest) {
  return excess_of(normalised_gaps(odometry, closures), fewest);
}

std::vector<double> remeasured_gaps(const std::vector<Edge>& first,
                                    const std::vector<Edge>& again) {
  std::vector<double> out;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const Matrix6 second = again[i].information - first[i].information;
    if (second.isZero()) continue;
    // Where both together lie, they pull equally: first * moved = second * (second's own move).
    const Twist moved = log_se3(first[i].from_from_to.inverse() * again[i].from_from_to);
    const Twist pull = first[i].information * moved;
    const Matrix6 solvable = second + 1e-6 * Matrix6::Identity();  // walls leave directions open
    out.push_back((moved.dot(pull) + pull.dot(solvable.ldlt().solve(pull))) / 6.0);
  }
  return out;
}

double remeasured_excess(const std::vector<Edge>& first,
                         const std::vector<Edge>& again,
                         std::size_t fewest) {
  return excess_of(remeasured_gaps(first, again), fewest);
}

}  // namespace loopbench
