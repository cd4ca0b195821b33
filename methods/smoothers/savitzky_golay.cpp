#include "methods/smoothers/savitzky_golay.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

#include "datasets/core/interpolate.hpp"
#include "datasets/core/knot_curve.hpp"
#include "methods/smoothers/runs/parts.hpp"

namespace loopbench::methods {
namespace {

constexpr std::size_t kMostTerms = SavitzkyGolay::kMaxDegree + 1;

/// Keyframes first..last - 1.
struct Neighbours {
  std::size_t first, last;
  std::size_t size() const { return last - first; }
};

/// Logarithm of `rotation` nearest to `near`; the rotation angle within a window may exceed pi.
Vector3 log_near(const Rotation& rotation, const Vector3& near) {
  const Vector3 shortest = log_so3(rotation);
  const double angle = shortest.norm();
  if (angle < 1e-6) return shortest;  // the axis is undetermined
  const Vector3 axis = shortest / angle;
  const double revolutions = std::round((axis.dot(near) - angle) / (2.0 * std::numbers::pi));
  return (angle + 2.0 * std::numbers::pi * revolutions) * axis;
}

/// Polynomial in x = (t - centre) / half, in the basis of polynomials orthogonal on the window's
/// times: p_{k+1} = (x - alpha_k) p_k - beta_k p_{k-1}.
class LocalPolynomial {
 public:
  LocalPolynomial(const Trajectory& keyframes,
                  std::size_t centre,
                  Neighbours window,
                  std::size_t terms)
      : centre_(keyframes[centre]), terms_(terms) {
    half_ = std::max(keyframes[window.last - 1].stamp - centre_.stamp,
                     centre_.stamp - keyframes[window.first].stamp);
    if (half_ == 0.0) half_ = 1.0;
    const std::vector<Twist> values = relative_twists(keyframes, centre, window);
    std::vector<double> x, current(window.size(), 1.0), previous(window.size(), 0.0);
    for (std::size_t i = window.first; i < window.last; ++i) {
      x.push_back((keyframes[i].stamp - centre_.stamp) / half_);
    }
    double square_previous = 1.0;
    for (std::size_t k = 0; k < terms; ++k) {
      Term& term = term_[k];
      double square = 0.0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        square += current[i] * current[i];
        term.alpha += x[i] * current[i] * current[i];
        term.weight += current[i] * values[i];
      }
      term.alpha /= square;
      term.beta = k == 0 ? 0.0 : square / square_previous;
      term.weight /= square;
      for (std::size_t i = 0; i < x.size(); ++i) {
        const double next = (x[i] - term.alpha) * current[i] - term.beta * previous[i];
        previous[i] = std::exchange(current[i], next);
      }
      square_previous = square;
    }
  }

  Pose at(double time) const {
    const double x = (time - centre_.stamp) / half_;
    Twist sum = Twist::Zero();
    double current = 1.0, previous = 0.0;
    for (std::size_t k = 0; k < terms_; ++k) {
      const Term& term = term_[k];
      sum += current * term.weight;
      const double next = (x - term.alpha) * current - term.beta * previous;
      previous = std::exchange(current, next);
    }
    return {(centre_.world_from_body.rotation * exp_so3(sum.tail<3>())).normalized(),
            centre_.world_from_body.translation + sum.head<3>()};
  }

 private:
  /// [world position offset; body rotation vector] of the window's keyframes relative to the
  /// centre.
  static std::vector<Twist> relative_twists(const Trajectory& keyframes,
                                            std::size_t centre,
                                            Neighbours window) {
    std::vector<Twist> out(window.size());
    const Pose& origin = keyframes[centre].world_from_body;
    const auto relative_to_centre = [&](std::size_t i, const Vector3& near) {
      const Pose& pose = keyframes[i].world_from_body;
      const Vector3 rotation_vector = log_near(origin.rotation.conjugate() * pose.rotation, near);
      out[i - window.first] = twist(pose.translation - origin.translation, rotation_vector);
      return rotation_vector;
    };
    Vector3 near = Vector3::Zero();
    for (std::size_t i = centre; i < window.last; ++i) near = relative_to_centre(i, near);
    near.setZero();
    for (std::size_t i = centre; i-- > window.first;) near = relative_to_centre(i, near);
    return out;
  }

  struct Term {
    double alpha = 0.0, beta = 0.0;
    Twist weight = Twist::Zero();
  };

  StampedPose centre_;
  double half_ = 1.0;  ///< half width of the window [s]
  std::size_t terms_;
  std::array<Term, kMostTerms> term_;
};

class LocalCurve final : public KnotCurve {
 public:
  LocalCurve(std::vector<double> stamps, std::vector<LocalPolynomial> pieces)
      : KnotCurve(std::move(stamps)), pieces_(std::move(pieces)) {}

 private:
  Pose evaluate(std::size_t i, double time) const override {
    const Pose before = pieces_[i].at(time);
    if (i + 1 == pieces_.size()) return before;  // only one keyframe
    const double u = fraction(i, time);
    const double share = u * u * (3.0 - 2.0 * u);
    return normalized(interpolate(before, pieces_[i + 1].at(time), share));
  }

  std::vector<LocalPolynomial> pieces_;
};

/// Extends the window towards the nearer neighbour until it holds `least` keyframes.
Neighbours widened(Neighbours window,
                   const Trajectory& keyframes,
                   std::size_t centre,
                   std::size_t least) {
  while (window.size() < least) {
    const bool has_left = window.first > 0;
    const bool has_right = window.last < keyframes.size();
    const double time = keyframes[centre].stamp;
    const bool left = has_left && (!has_right || time - keyframes[window.first - 1].stamp <=
                                                     keyframes[window.last].stamp - time);
    left ? --window.first : ++window.last;
  }
  return window;
}

}  // namespace

SavitzkyGolay::SavitzkyGolay(const Options& options) : options_(options) {
  if (!options.seconds && options.window <= options.degree) {
    throw OptionError("window",
                      "window = " + std::to_string(options.window) +
                          ": expected more than degree = " + std::to_string(options.degree));
  }
}

std::string SavitzkyGolay::why_declined(const Problem& problem) const {
  return too_few_keyframes(problem.keyframes, static_cast<std::size_t>(options_.degree) + 1);
}

std::unique_ptr<const Curve> SavitzkyGolay::smooth(const Problem& problem, Report& report) const {
  const Trajectory& keyframes = problem.keyframes;
  const std::size_t terms = static_cast<std::size_t>(options_.degree) + 1;
  const std::size_t width = std::min(static_cast<std::size_t>(options_.window), keyframes.size());
  std::vector<LocalPolynomial> pieces;
  pieces.reserve(keyframes.size());
  Neighbours window{0, 0};
  double members = 0.0;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    if (options_.seconds) {
      const double half = 0.5 * *options_.seconds;
      while (keyframes[i].stamp - keyframes[window.first].stamp > half) ++window.first;
      while (window.last < keyframes.size() &&
             keyframes[window.last].stamp - keyframes[i].stamp <= half) {
        ++window.last;
      }
    } else {
      const std::size_t centred_first = i - std::min(i, width / 2);
      window.first = std::min(centred_first, keyframes.size() - width);
      window.last = window.first + width;
    }
    const Neighbours widened_window = widened(window, keyframes, i, terms);
    members += static_cast<double>(widened_window.size());
    pieces.emplace_back(keyframes, i, widened_window, terms);
  }
  report.count("window", members / static_cast<double>(keyframes.size()));
  return std::make_unique<LocalCurve>(stamps(keyframes), std::move(pieces));
}

}  // namespace loopbench::methods
