/// Notes in words, where they are printed.
#pragma once

#include <string>
#include <vector>

#include "harness/sweep/model/note.hpp"

namespace loopbench::harness {

/// One sentence without a full stop, with the subject and the remedy.
std::string text(const Note& note);

/// The sentences, in order.
std::vector<std::string> texts(const std::vector<Note>& notes);

}  // namespace loopbench::harness
