#include "metrics/doctor/swapped.hpp"

#include <fmt/format.h>

#include <cctype>
#include <filesystem>

namespace loopbench::metrics {
namespace {

/// Lower-case words of the last two parts of a path, separated by '_', '-', '.' and '/'.
bool names_truth(const std::string& name) {
  const std::filesystem::path path(name);
  const std::string tail = (path.parent_path().filename() / path.filename()).string() + "/";
  std::string word;
  for (const char c : tail) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isalpha(letter) != 0) {
      word += static_cast<char>(std::tolower(letter));
      continue;
    }
    for (const char* const known :
         {"groundtruth", "truth", "gt", "reference", "vicon", "leica", "mocap"}) {
      if (word == known) return true;
    }
    word.clear();
  }
  return false;
}

double rate(const Trajectory& poses) {
  const double duration = poses.back().stamp - poses.front().stamp;
  return duration > 0.0 ? static_cast<double>(poses.size() - 1) / duration : 0.0;
}

}  // namespace

std::optional<InputFinding> check_swapped(const Trajectory& reference,
                                          const Trajectory& estimate,
                                          const std::string& reference_name,
                                          const std::string& estimate_name) {
  constexpr double kRates = 2.0;
  if (reference.size() < 2 || estimate.size() < 2) return std::nullopt;
  const bool reference_is_named = names_truth(reference_name);
  const bool estimate_is_named = names_truth(estimate_name);
  if (reference_is_named) return std::nullopt;
  const double rates = rate(estimate) / rate(reference);
  const bool covers = estimate.front().stamp <= reference.front().stamp &&
                      estimate.back().stamp >= reference.back().stamp;
  const bool is_denser = rates >= kRates && covers;
  if (!estimate_is_named && !is_denser) return std::nullopt;
  return InputFinding{
      Fault::swapped,
      fmt::format("the estimate {}",
                  estimate_is_named ? "is named like a reference: " + estimate_name
                                    : fmt::format("has {:.1f} times the rate of the reference and "
                                                  "covers it in time",
                                                  rates)),
      "exchange REF and EST",
      estimate_is_named && is_denser ? 0.98
      : estimate_is_named            ? 0.9
                                     : 0.7,
      rates};
}

}  // namespace loopbench::metrics
