#include "harness/sweep/text/pattern.hpp"

#include <re2/re2.h>

#include "datasets/core/error.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kLongestPattern = 1'000;  // longer patterns are mistakes

re2::StringPiece piece(std::string_view text) { return {text.data(), text.size()}; }

}  // namespace

Pattern::Pattern(std::string_view expression) {
  if (expression.size() > kLongestPattern) {
    throw InputError("the pattern is longer than 1000 characters");
  }
  compiled_ = std::make_shared<const re2::RE2>(piece(expression), re2::RE2::Quiet);
  if (!compiled_->ok()) {
    throw InputError("'" + std::string(expression) + "' is not a regular expression (" +
                     compiled_->error() + ")");
  }
}

Pattern Pattern::of_option(std::string_view option, std::string_view expression) {
  try {
    return Pattern(expression);
  } catch (const InputError& error) {
    throw InputError(std::string(option) + ": " + error.what());
  }
}

bool Pattern::matches_part(std::string_view text) const {
  return re2::RE2::PartialMatch(piece(text), *compiled_);
}

bool Pattern::matches(std::string_view text) const {
  return re2::RE2::FullMatch(piece(text), *compiled_);
}

std::optional<std::vector<std::string>> Pattern::groups(std::string_view text) const {
  std::vector<re2::StringPiece> found(
      static_cast<std::size_t>(compiled_->NumberOfCapturingGroups()) + 1);
  if (!compiled_->Match(piece(text),
                        0,
                        text.size(),
                        re2::RE2::ANCHOR_BOTH,
                        found.data(),
                        static_cast<int>(found.size()))) {
    return std::nullopt;
  }
  std::vector<std::string> out;
  for (const re2::StringPiece& each : found) out.emplace_back(each.data(), each.size());
  out.erase(out.begin());  // the complete match
  return out;
}

std::string Pattern::replaced(std::string text, std::string_view replacement) const {
  re2::RE2::GlobalReplace(&text, *compiled_, piece(replacement));
  return text;
}

}  // namespace loopbench::harness
