#include "tests/studies/left_out.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace loopbench {
namespace {

constexpr double kAbove = 1.05;

std::size_t best_without(const std::vector<GroupRatios>& groups, const std::string& part) {
  const std::size_t settings = groups.front().logs.front().size();
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t s = 0; s < settings; ++s) {
    double sum = 0.0;
    for (const GroupRatios& group : groups) {
      if (group.part != part) sum += mean_log(group, s);
    }
    if (sum < least) {
      least = sum;
      best = s;
    }
  }
  return best;
}

}  // namespace

double mean_log(const GroupRatios& group, std::size_t setting) {
  double sum = 0.0;
  for (const std::vector<double>& chain : group.logs) sum += chain[setting];
  return sum / static_cast<double>(group.logs.size());
}

LeftOutEstimate left_out(const std::vector<GroupRatios>& groups, int draws) {
  LeftOutEstimate out;
  const auto count = static_cast<double>(groups.size());
  double sum = 0.0;
  for (const GroupRatios& group : groups) {
    const std::size_t s = out.chosen.emplace_back(best_without(groups, group.part));
    sum += mean_log(group, s);
    for (const std::vector<double>& chain : group.logs) {
      out.worst = std::max(out.worst, std::exp(chain[s]));
      out.above += std::exp(chain[s]) > kAbove;
    }
  }
  out.ratio = std::exp(sum / count);

  std::mt19937_64 bits(1);
  const auto draw = [&](std::size_t size) { return static_cast<std::size_t>(bits() % size); };
  std::vector<double> means;
  for (int i = 0; i < draws; ++i) {
    double total = 0.0;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const std::size_t drawn = draw(groups.size());
      const auto& logs = groups[drawn].logs;
      double mean = 0.0;
      for (std::size_t k = 0; k < logs.size(); ++k) {
        mean += logs[draw(logs.size())][out.chosen[drawn]] / static_cast<double>(logs.size());
      }
      total += mean / count;
    }
    means.push_back(total);
  }
  std::ranges::sort(means);
  const auto at = [&](double part) {
    return std::exp(means[static_cast<std::size_t>(part * static_cast<double>(means.size() - 1))]);
  };
  out.low = at(0.025);
  out.high = at(0.975);
  return out;
}

}  // namespace loopbench
