#include "harness/eval/note_summary.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace loopbench::harness {
namespace {

constexpr std::string_view kDoctor = "doctor: ";

std::string kind_of_note(const std::string& note) {
  const std::size_t begin = note.starts_with(kDoctor) ? kDoctor.size() : 0;
  return note.substr(0, note.find(':', begin));
}

}  // namespace

void NoteSummary::add(const std::string& file, const std::vector<std::string>& notes) {
  for (const std::string& note : notes) {
    const std::string name = kind_of_note(note);
    const auto known = std::ranges::find(kinds_, name, &Kind::name);
    if (known == kinds_.end()) {
      kinds_.push_back({name, file, file, note});
    } else if (known->last_file != file) {
      known->last_file = file;
      ++known->files;
    }
  }
}

std::vector<std::string> NoteSummary::lines() const {
  std::vector<Kind> sorted = kinds_;
  std::stable_partition(sorted.begin(), sorted.end(), [](const Kind& kind) {
    return kind.name.starts_with(kDoctor);
  });
  const bool fits = sorted.size() <= kMostLines;
  const std::size_t shown = fits ? sorted.size() : kMostLines - 1;
  std::vector<std::string> out;
  for (std::size_t i = 0; i < shown; ++i) {
    const std::size_t more = sorted[i].files - 1;
    out.push_back(sorted[i].first_file + ": " + sorted[i].text);
    if (more > 0) out.back() += fmt::format(" (and {} more run{})", more, more == 1 ? "" : "s");
  }
  if (fits) return out;
  out.push_back(
      fmt::format("and {} other kinds of notes, which eval without --store prints for each file",
                  sorted.size() - shown));
  return out;
}

}  // namespace loopbench::harness
