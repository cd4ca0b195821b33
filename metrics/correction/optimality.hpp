/// Certificate of global optimality of a pose graph.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench::metrics {

/// Bounds of the isotropic chordal cost (chordal_weights.hpp), the sum over all edges of
///     kappa |R_to - R_from Z_R|_F^2 + tau |t_to - t_from - R_from Z_t|^2.
struct Certificate {
  double cost = 0.0;         ///< at the given poses
  double minimum = 0.0;      ///< at the local minimum that Newton's method reaches from them
  double lower_bound = 0.0;  ///< of the cost of any poses; 0: nothing is proved
  double rotation = 0.0;     ///< largest rotation between the poses and that minimum [rad]
};

/// With X = [t_0 R_0 t_1 R_1 ..] the cost is tr(X M X'). For any symmetric L_i, if the matrix
/// S = M - diag(0, L_i - eta I) is positive semidefinite, then no poses cost less than
/// sum tr(L_i) - d n eta. L_i are the multipliers of R_i' R_i = I at the minimum, and a sparse
/// Cholesky factorisation tests S: first for eta = 1e-7 of the cost, then by bisection up to a
/// tenth of it. The bound is reduced by an allowance for rounding. Poses of planar problems are
/// projected to the plane of keyframe 0. Two to eight factorisations, and those of chordal_minimum.
/// Throws std::runtime_error if the cost is not finite. Source: Rosen, Carlone, Bandeira, Leonard,
/// SE-Sync, IJRR 2019; Carlone et al., Lagrangian duality in 3D SLAM, IROS 2015.
Certificate certificate(const Problem& problem, const Trajectory& keyframes);

/// `gap`, axis `minimum` [%]: no poses have a chordal cost that is lower by more than this share of
/// the minimum that Newton's method reaches from the estimate. Below 1e-4 that minimum is globally
/// optimal; 100: nothing is proved. If it lies more than 90 degrees from the estimate, it is not
/// the estimate's minimum, and the gap is that of the estimate. Axis `estimate` [%]: the same share
/// of the estimate's own chordal cost, which methods that use the whole information do not
/// minimise. `rotation` [deg]: largest rotation between both. Needs no reference. Throws Undefined
/// if an edge changes the scale.
std::vector<Score> optimality(const Evaluation& evaluation, const NoOptions& options);

/// A gap in words: "globally optimal" below 1e-4 %, "not proved" from 100 %, otherwise "at most x".
std::string gap_text(double percent);

}  // namespace loopbench::metrics
