// How often the interval of a time offset contains the true one, over recordings with offsets of
// 0.02 to 100 s.
//   build/release/tests/studies/offset_intervals FIRST_SEED CASES [-v]
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string_view>

#include "datasets/core/so3.hpp"
#include "metrics/doctor/pair_checks.hpp"

using namespace loopbench;
using namespace loopbench::metrics;

namespace {

constexpr double kStep = 0.01;  // of the simulation [s]

/// An Ornstein-Uhlenbeck process of deviation 1.
class Process {
 public:
  explicit Process(double time) : keep_(std::exp(-kStep / time)) {}

  double next(std::mt19937& random) {
    return value_ = keep_ * value_ + std::sqrt(1.0 - keep_ * keep_) * normal_(random);
  }

 private:
  double keep_, value_ = 0.0;
  std::normal_distribution<double> normal_;
};

double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// True poses every kStep: a vehicle, or a camera in a hand.
Trajectory motion(double seconds, bool is_hand, std::mt19937& random) {
  const double time = is_hand ? uniform(random, 0.5, 2.0) : uniform(random, 1.5, 15.0);
  const double usual = is_hand ? 0.4 : uniform(random, 3.0, 15.0);
  std::array<Process, 6> all{Process(time),
                             Process(time),
                             Process(time),
                             Process(time),
                             Process(time),
                             Process(2.0 * time)};
  Trajectory out;
  Pose at;
  for (double t = 0.0; t < seconds; t += kStep) {
    out.push_back({t, at});
    std::array<double, 6> now{};
    for (std::size_t k = 0; k < all.size(); ++k) now[k] = all[k].next(random);
    const Vector3 speed = is_hand ? Vector3(0.4 * Vector3(now[0], now[1], now[2]))
                                  : Vector3(usual * std::max(0.0, 1.0 + 0.4 * now[0]), 0.0, 0.0);
    const Vector3 turn = is_hand ? Vector3(0.5 * Vector3(now[3], now[4], now[5]))
                                 : Vector3(0.02 * now[3], 0.02 * now[4], 0.2 * now[5]);
    at.translation += at.rotation * (kStep * speed);
    at.rotation = (at.rotation * exp_so3(kStep * turn)).normalized();
  }
  return out;
}

/// Poses at `rate` [Hz] within a range of times, with white noise.
Trajectory measured(const Trajectory& truth,
                    double rate,
                    std::pair<double, double> range,
                    double metres,
                    bool has_rotations,
                    std::mt19937& random) {
  std::normal_distribution<double> normal;
  const auto noise = [&] { return Vector3(normal(random), normal(random), normal(random)); };
  Trajectory out;
  for (double t = range.first; t < range.second; t += 1.0 / rate) {
    const auto index = static_cast<std::size_t>(std::lround(t / kStep));
    if (index >= truth.size()) break;
    StampedPose each = truth[index];
    each.world_from_body.translation += metres * noise();
    Rotation& rotation = each.world_from_body.rotation;
    if (has_rotations) rotation = rotation * exp_so3(0.3 * metres * noise());
    if (!has_rotations) rotation = no_rotation();
    out.push_back(each);
  }
  return out;
}

struct Tally {
  int all = 0, stated = 0, covered = 0, far = 0;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "usage: offset_intervals FIRST_SEED CASES [-v]\n");
    return 2;
  }
  const auto first = static_cast<unsigned>(std::atoi(argv[1]));
  const auto cases = static_cast<unsigned>(std::atoi(argv[2]));
  const bool is_verbose = argc > 3 && std::string_view(argv[3]) == "-v";
  constexpr std::array kClasses{0.02, 0.2, 2.0, 20.0, 100.0};  // ends of the classes [s]
  std::array<Tally, kClasses.size()> tallies;                  // the last one: of all
  for (unsigned seed = first; seed < first + cases; ++seed) {
    std::mt19937 random(seed);
    const std::size_t of = seed % (kClasses.size() - 1);
    double offset = std::exp(uniform(random, std::log(kClasses[of]), std::log(kClasses[of + 1])));
    const double size = offset;
    if (random() % 2 == 0) offset = -offset;
    const bool is_hand = random() % 3 == 0, has_rotations = random() % 2 == 0;
    const double seconds = uniform(random, 60.0, is_hand ? 180.0 : 400.0) + 1.5 * size;
    const Trajectory truth = motion(seconds, is_hand, random);
    const double metres = uniform(random, 0.002, 0.03);
    const double rate =
        std::array{1.0, 4.0, 5.0, 20.0, 100.0}[is_hand ? 2 + random() % 3 : random() % 5];
    const double begin = uniform(random, 0.0, 10.0), end = seconds - uniform(random, 0.0, 10.0);
    const Trajectory reference = measured(truth, rate, {begin, end}, metres, has_rotations, random);
    Trajectory estimate = measured(truth,
                                   std::array{10.0, 20.0, 25.0}[random() % 3],
                                   {uniform(random, 0.0, 10.0), seconds},
                                   metres,
                                   true,
                                   random);
    for (StampedPose& pose : estimate) pose.stamp -= offset;
    const auto found = estimate_time_offset(reference, estimate);
    const bool is_covered = found && std::abs(found->offset - offset) <= found->half_interval();
    const bool is_far = found && std::abs(found->offset - offset) > 0.5;
    for (Tally* tally : {&tallies[of], &tallies.back()}) {
      ++tally->all;
      tally->stated += found ? 1 : 0;
      tally->covered += is_covered ? 1 : 0;
      tally->far += is_far ? 1 : 0;
    }
    if (!is_verbose || is_covered) continue;
    fmt::print(stderr,
               "{}: {:.4f} s, {:g} Hz, {}{}",
               seed,
               offset,
               rate,
               is_hand ? "hand" : "vehicle",
               has_rotations ? "" : ", positions");
    if (found) fmt::print(stderr, ": {:.4f} +- {:.4f}", found->offset, found->half_interval());
    fmt::print(stderr, "\n");
  }
  fmt::print("| offset [s] | cases | stated [%] | interval contains it [%] | wrong by 0.5 s |\n");
  fmt::print("| --- | ---: | ---: | ---: | ---: |\n");
  for (std::size_t k = 0; k < tallies.size(); ++k) {
    const Tally& t = tallies[k];
    const std::string name =
        k + 1 == tallies.size() ? "all" : fmt::format("{:g} to {:g}", kClasses[k], kClasses[k + 1]);
    fmt::print("| {} | {} | {:.1f} | {:.1f} | {} |\n",
               name,
               t.all,
               100.0 * t.stated / std::max(1, t.all),
               100.0 * t.covered / std::max(1, t.stated),
               t.far);
  }
  return 0;
}
