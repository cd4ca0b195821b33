#include "methods/solvers/graph_covariance.hpp"

#include <algorithm>
#include <cmath>

#include "datasets/core/covariance.hpp"
#include "methods/solvers/anchor_residual.hpp"
#include "methods/solvers/edge_residual.hpp"
#include "methods/solvers/groups/se2.hpp"
#include "methods/solvers/groups/se3.hpp"
#include "methods/solvers/groups/sim3.hpp"
#include "methods/solvers/selected_inverse.hpp"

namespace loopbench::methods {
namespace {

/// Derivative of the loss with respect to the squared error.
double derivative_of_loss(const PoseGraphSettings& settings, double squared) {
  const double width = settings.loss_width;
  const double s = width / (width + squared);
  switch (settings.loss) {
    case RobustLoss::none:
      return 1.0;
    case RobustLoss::huber:
      return squared <= width ? 1.0 : std::sqrt(width / squared);
    case RobustLoss::cauchy:
      return s;
    case RobustLoss::dcs:
      return std::min(1.0, 4.0 * s * s);
  }
  return 1.0;
}

/// Columns of a twist [rho; phi] that the group moves.
template <class G>
int twist_axis(int i) {
  constexpr int kPlane[] = {0, 1, 5};
  return G::kDof == 3 ? kPlane[i] : i;
}

/// Lower triangle of the information matrix over the poses from `first` on, in complete blocks.
template <class G>
class Information {
 public:
  explicit Information(std::size_t first) : first_(first) {}

  void add(std::size_t row, std::size_t column, const typename G::Square& block) {
    if (row < first_ || column < first_) return;
    for (int r = 0; r < G::kDof; ++r) {
      for (int c = 0; c < G::kDof; ++c) {
        if (row == column && r < c) continue;
        entries_.emplace_back(index(row) + r, index(column) + c, block(r, c));
      }
    }
  }

  Eigen::SparseMatrix<double> matrix(std::size_t poses) const {
    Eigen::SparseMatrix<double> out(index(poses), index(poses));
    out.setFromTriplets(entries_.begin(), entries_.end());
    return out;
  }

 private:
  int index(std::size_t pose) const { return G::kDof * static_cast<int>(pose - first_); }

  std::size_t first_;
  std::vector<Eigen::Triplet<double>> entries_;
};

/// Information of an anchor about d in X Exp(d).
template <class G>
typename G::Square anchor_information(const Anchor& anchor, const Pose& world_from_body) {
  const AnchorResidual at = anchor_residual(anchor, world_from_body);
  Eigen::Matrix<double, 3, G::kDof> J = Eigen::Matrix<double, 3, G::kDof>::Zero();
  for (int i = 0; i < std::min(G::kDof, 6); ++i) J.col(i) = at.by_pose.col(twist_axis<G>(i));
  return J.transpose() * anchor.covariance.inverse() * J;
}

/// Twists are relative to each pose, so that the world frame does not matter.
template <class G>
std::vector<Matrix6> covariances_in(const std::vector<ScaledPose>& poses,
                                    const std::vector<Edge>& odometry,
                                    const std::vector<Edge>& closures,
                                    const std::vector<double>& weights,
                                    const PoseGraphSettings& settings) {
  const std::size_t first = settings.is_first_free ? 0 : 1;
  const ScaledPose first_from_world = poses.front().inverse();
  Information<G> information(first);
  const auto add = [&](const Edge& edge, double weight, bool has_loss) {
    const EdgeResidual<G> at = edge_residual<G>(G::inverse(G::from(measured(edge))),
                                                G::from(first_from_world * poses[edge.from]),
                                                G::from(first_from_world * poses[edge.to]));
    typename G::Square omega = weight * G::information(edge, settings.scale_sigma);
    if (has_loss) omega *= derivative_of_loss(settings, at.error.dot(omega * at.error));
    information.add(edge.from, edge.from, at.by_from.transpose() * omega * at.by_from);
    information.add(edge.to, edge.to, at.by_to.transpose() * omega * at.by_to);
    information.add(edge.to, edge.from, at.by_to.transpose() * omega * at.by_from);
  };
  for (const Edge& edge : odometry) add(edge, 1.0, false);
  for (std::size_t k = 0; k < closures.size(); ++k) {
    if (weights[k] > 0.0) add(closures[k], weights[k], true);
  }
  for (const Anchor& anchor : settings.anchors) {
    information.add(anchor.keyframe,
                    anchor.keyframe,
                    anchor_information<G>(anchor, poses[anchor.keyframe].pose));
  }
  const std::vector<Eigen::MatrixXd> blocks =
      inverse_diagonal_blocks(information.matrix(poses.size()), G::kDof);
  std::vector<Matrix6> out(poses.size(), Matrix6::Zero());
  for (std::size_t i = first; i < poses.size(); ++i) {
    Matrix6 of_twist = Matrix6::Zero();
    for (int r = 0; r < std::min(G::kDof, 6); ++r) {
      for (int c = 0; c < std::min(G::kDof, 6); ++c) {
        of_twist(twist_axis<G>(r), twist_axis<G>(c)) = blocks[i - first](r, c);
      }
    }
    const Pose& pose = poses[i].pose;
    const double scale = G::kDof == 7 ? poses[i].scale : 1.0;
    out[i] = rotated(of_twist, pose.rotation.toRotationMatrix(), scale);
  }
  return out;
}

}  // namespace

std::vector<Matrix6> graph_covariances(const std::vector<ScaledPose>& poses,
                                       const std::vector<Edge>& odometry,
                                       const std::vector<Edge>& closures,
                                       const std::vector<double>& weights,
                                       const PoseGraphSettings& settings) {
  if (poses.empty()) return {};
  switch (settings.group) {
    case Group::se2:
      return covariances_in<Se2>(poses, odometry, closures, weights, settings);
    case Group::se3:
      return covariances_in<Se3>(poses, odometry, closures, weights, settings);
    case Group::sim3:
      return covariances_in<Sim3>(poses, odometry, closures, weights, settings);
  }
  return {};
}

}  // namespace loopbench::methods
