#include "methods/smoothers/savitzky_golay.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

#include "datasets/core/interpolate.hpp"
#include "datasets/core/knot_span.hpp"

namespace loopbench {
namespace {

constexpr std::size_t kMostTerms = SavitzkyGolay::kMostDegree + 1;

/// Keyframes first..last - 1.
struct Neighbours {
  std::size_t first, last;
  std::size_t size() const { return last - first; }
};

/// The tangent vector of `rotation` nearest to `near`: a window may turn by more than pi.
Vector3 log_near(const Rotation& rotation, const Vector3& near) {
  const Vector3 shortest = log_so3(rotation);
  const double angle = shortest.norm();
  if (angle < 1e-6) return shortest;  // its axis is noise
  const Vector3 axis = shortest / angle;
  const double turns = std::round((axis.dot(near) - angle) / (2.0 * std::numbers::pi));
  return (angle + 2.0 * std::numbers::pi * turns) * axis;
}

/// A polynomial in x = (t - centre) / half, by orthogonal polynomials on the window's times:
/// p_{k+1} = (x - alpha_k) p_k - beta_k p_{k-1}.
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
    const std::vector<Twist> values = around(keyframes, centre, window);
    std::vector<double> x, now(window.size(), 1.0), before(window.size(), 0.0);
    for (std::size_t i = window.first; i < window.last; ++i) {
      x.push_back((keyframes[i].stamp - centre_.stamp) / half_);
    }
    double square_before = 1.0;
    for (std::size_t k = 0; k < terms; ++k) {
      Term& term = term_[k];
      double square = 0.0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        square += now[i] * now[i];
        term.alpha += x[i] * now[i] * now[i];
        term.weight += now[i] * values[i];
      }
      term.alpha /= square;
      term.beta = k == 0 ? 0.0 : square / square_before;
      term.weight /= square;
      for (std::size_t i = 0; i < x.size(); ++i) {
        const double next = (x[i] - term.alpha) * now[i] - term.beta * before[i];
        before[i] = std::exchange(now[i], next);
      }
      square_before = square;
    }
  }

  Pose at(double time) const {
    const double x = (time - centre_.stamp) / half_;
    Twist sum = Twist::Zero();
    double now = 1.0, before = 0.0;
    for (std::size_t k = 0; k < terms_; ++k) {
      const Term& term = term_[k];
      sum += now * term.weight;
      const double next = (x - term.alpha) * now - term.beta * before;
      before = std::exchange(now, next);
    }
    return {(centre_.world_from_body.rotation * exp_so3(sum.tail<3>())).normalized(),
            centre_.world_from_body.translation + sum.head<3>()};
  }

 private:
  /// [offset in the world; turn in the body] of the window's keyframes from the centre.
  static std::vector<Twist> around(const Trajectory& keyframes,
                                   std::size_t centre,
                                   Neighbours window) {
    std::vector<Twist> out(window.size());
    const Pose& origin = keyframes[centre].world_from_body;
    const auto put = [&](std::size_t i, const Vector3& near) {
      const Pose& pose = keyframes[i].world_from_body;
      const Vector3 turn = log_near(origin.rotation.conjugate() * pose.rotation, near);
      out[i - window.first] = twist(pose.translation - origin.translation, turn);
      return turn;
    };
    Vector3 near = Vector3::Zero();
    for (std::size_t i = centre; i < window.last; ++i) near = put(i, near);
    near.setZero();
    for (std::size_t i = centre; i-- > window.first;) near = put(i, near);
    return out;
  }

  struct Term {
    double alpha = 0.0, beta = 0.0;
    Twist weight = Twist::Zero();
  };

  StampedPose centre_;
  double half_ = 1.0;  ///< [s]
  std::size_t terms_;
  std::array<Term, kMostTerms> term_;
};

class LocalCurve final : public Curve {
 public:
  LocalCurve(std::vector<double> stamps, std::vector<LocalPolynomial> pieces)
      : stamps_(std::move(stamps)), pieces_(std::move(pieces)) {}

  double start() const override { return stamps_.front(); }
  double end() const override { return stamps_.back(); }

  using Curve::sample;
  void sample(std::span<const double> times, std::span<Pose> poses) const override {
    KnotSpan span(stamps_);
    for (std::size_t k = 0; k < times.size(); ++k) {
      const std::size_t i = span.find(times[k]);
      poses[k] = pieces_[i].at(times[k]);
      if (i + 1 == stamps_.size()) continue;  // a single keyframe
      const double u = (times[k] - stamps_[i]) / (stamps_[i + 1] - stamps_[i]);
      const double share = u * u * (3.0 - 2.0 * u);
      poses[k] = normalized(interpolate(poses[k], pieces_[i + 1].at(times[k]), share));
    }
  }

 private:
  std::vector<double> stamps_;
  std::vector<LocalPolynomial> pieces_;
};

/// Grows towards the nearer neighbour until it holds `least` keyframes.
Neighbours widened(Neighbours window,
                   const Trajectory& keyframes,
                   std::size_t centre,
                   std::size_t least) {
  while (window.size() < least) {
    const bool can_left = window.first > 0;
    const bool can_right = window.last < keyframes.size();
    const double time = keyframes[centre].stamp;
    const bool left = can_left && (!can_right || time - keyframes[window.first - 1].stamp <=
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
                          " breaks window > degree = " + std::to_string(options.degree));
  }
}

std::optional<std::string> SavitzkyGolay::declines(const Problem& problem) const {
  const int needed = options_.degree + 1;
  if (problem.keyframes.size() >= static_cast<std::size_t>(needed)) return std::nullopt;
  return "fewer than degree + 1 = " + std::to_string(needed) + " keyframes";
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
      const std::size_t wanted = i - std::min(i, width / 2);
      window.first = std::min(wanted, keyframes.size() - width);
      window.last = window.first + width;
    }
    const Neighbours enough = widened(window, keyframes, i, terms);
    members += static_cast<double>(enough.size());
    pieces.emplace_back(keyframes, i, enough, terms);
  }
  report.count("window", members / static_cast<double>(keyframes.size()));
  return std::make_unique<LocalCurve>(stamps(keyframes), std::move(pieces));
}

}  // namespace loopbench
