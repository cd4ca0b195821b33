/// Condenses the notes of many files.
#pragma once

#include <string>
#include <vector>

namespace loopbench::harness {

/// Notes of one kind (the text before the first colon, or the second one after "doctor:") are one
/// line: that of the first file with it, and the number of further files.
class NoteSummary {
 public:
  void add(const std::string& file, const std::vector<std::string>& notes);

  /// "FILE: doctor: time_offset: ... (and 9 more runs)": findings of the doctor first, then in
  /// order of appearance. At most kMostLines; the last one then states the number of other kinds.
  std::vector<std::string> lines() const;

  static constexpr std::size_t kMostLines = 5;

 private:
  struct Kind {
    std::string name;
    std::string first_file;
    std::string last_file;  ///< a file can have several notes of one kind
    std::string text;
    std::size_t files = 1;
  };

  std::vector<Kind> kinds_;
};

}  // namespace loopbench::harness
