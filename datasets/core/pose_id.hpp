/// Ids of poses in graphs, as text.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace loopbench {

/// Number of lower bits of a symbol of GTSAM, in which its index is; a letter is above them.
inline constexpr int kSymbolBits = 56;

/// Whether the id is a symbol of GTSAM: a letter in the highest byte, which graphs of several
/// robots have as the robot's.
bool is_symbol(std::int64_t id);

/// "a12" for a symbol of GTSAM, else the number.
std::string id_text(std::int64_t id);

/// The id that is the whole text: a number, or letter and index of a symbol. nullopt: none.
std::optional<std::int64_t> id_of(std::string_view text);

}  // namespace loopbench
