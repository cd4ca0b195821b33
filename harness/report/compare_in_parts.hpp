/// Comparisons of all scores of a store that do not fit into memory at once.
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "harness/compare/compare.hpp"
#include "harness/store/record_reader.hpp"

namespace loopbench::harness {

/// The metrics that can be compared, in order of appearance, with their numbers of scores.
class ComparedMetrics {
 public:
  using MetricLabel = std::pair<SharedText, SharedText>;  ///< name and label

  void add(const Record& record);

  /// Parts of about kMostValues scores.
  std::vector<std::set<MetricLabel>> parts() const;

  bool is_small() const { return total_ <= kMostValues; }

 private:
  static constexpr std::size_t kMostValues = 6'000'000;  ///< about 200 MB

  std::map<MetricLabel, std::size_t> index_;
  std::vector<std::pair<MetricLabel, std::size_t>> metrics_;
  std::size_t total_ = 0;
};

/// The comparisons of all scores, a few metrics at a time if there are many scores. Restricts the
/// reader to the last part.
std::vector<Comparison> compare_in_parts(RecordReader& reader,
                                         const ComparedMetrics& metrics,
                                         const std::string& baseline);

}  // namespace loopbench::harness
