/// The notes of a store, equal ones counted: "29 of 30 runs of rp: ...".
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "harness/sweep/model/note.hpp"

namespace loopbench::harness {

/// Notes of one kind with one remedy: of the runs of a sweep, or of the runs of one method.
struct CountedNote {
  Note note;                           ///< of the run with the median of the first number
  std::string example;                 ///< name of that run
  std::string method;                  ///< whose runs or files; empty: of all methods
  std::vector<std::string> sequences;  ///< of a sweep, in order; empty if all have it
  std::size_t runs = 0;                ///< with the note
  std::size_t of = 0;                  ///< runs of the sweep or method
};

/// Those that can change a conclusion first, then in order of appearance. `rules`: only of the runs
/// that pass, see model/where.hpp; rules about scores do not matter. Throws InputError.
/// O(notes + cells).
std::vector<CountedNote> counted_notes(const std::filesystem::path& store,
                                       const std::vector<std::string>& rules = {});

/// "29 of 30 runs of rp, for example room: doctor: ...".
std::string text(const CountedNote& note);

/// The texts of notes of at least this severity.
std::vector<std::string> texts(const std::vector<CountedNote>& notes, Severity least);

/// Array of {kind, severity, subject, numbers {name: [value, unit]}, remedy, text, runs, of,
/// method, sequences}.
std::string json(const std::vector<CountedNote>& notes, int indent = 2);

}  // namespace loopbench::harness
