/// What the scores of a cell are (protocol, metric, axis, ...), stored once for all cells that have
/// the same list of scores, and their numbers, stored as one row per cell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "harness/store/sqlite.hpp"
#include "harness/text/shared_text.hpp"
#include "metrics/numerics/statistics.hpp"

namespace loopbench::harness {

/// The texts of one score.
struct ScoreDefinition {
  SharedText protocol;
  SharedText protocol_version;
  SharedText times;
  SharedText metric;
  SharedText label;
  SharedText relation;
  SharedText axis;
  SharedText unit;
  SharedText better;
  double target = 0.0;

  bool operator==(const ScoreDefinition&) const = default;
};

using ScoreList = std::vector<ScoreDefinition>;

/// Key of table score_list: a hash of all fields.
std::string key_of(const ScoreList& list);

/// By key.
using ScoreListMap = std::map<std::string, ScoreList, std::less<>>;

/// All lists of a store. They are stored twice, on different pages, because a damaged list would
/// cost all its cells; a list whose key does not match its content is ignored.
class ScoreLists {
 public:
  /// Reads the intact lists of the database or, with `schema` "source.", of an attached one.
  explicit ScoreLists(Database& database, const std::string& schema = "");

  /// nullptr if it is missing or damaged.
  const ScoreList* find(std::string_view key) const;

  /// Whether both copies are complete.
  bool intact() const { return intact_; }

  const ScoreListMap& all() const { return lists_; }

 private:
  ScoreListMap lists_;
  bool intact_ = true;
};

/// Writes both copies of a list.
void write_list(Database& database, const std::string& key, const ScoreList& list);

/// Replaces the stored lists by these.
void rewrite_lists(Database& database, const ScoreLists& lists);

/// Bytes of one score in the column `numbers`: 11 doubles, big endian.
inline constexpr std::size_t kPackedScore = 88;

/// The numbers of one score.
struct ScoreNumbers {
  metrics::Statistics statistics;
  std::int64_t pairs = 0;
  std::int64_t possible = 0;
  double span = 0.0;
};

/// Appends them to the column `numbers`. -0 becomes 0, as in any column of SQLite.
void pack(const ScoreNumbers& numbers, std::string& bytes);

/// The numbers of score `index`; `bytes` holds more than `index` scores.
ScoreNumbers unpacked(std::string_view bytes, std::size_t index);

/// The list of a row of table scores; nullptr if it is missing or does not fit the numbers.
const ScoreList* list_of(const ScoreLists& lists, std::string_view key, std::string_view numbers);

/// The column `statuses`: empty if all statuses are ok without a reason; otherwise status and
/// reason of each score, separated by kStatusSeparator.
inline constexpr char kStatusSeparator = '\x1f';
std::string joined_statuses(const std::vector<std::string>& statuses_and_reasons);
std::vector<std::string> split_statuses(std::string_view statuses, std::size_t scores);

}  // namespace loopbench::harness
