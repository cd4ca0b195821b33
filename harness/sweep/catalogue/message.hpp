/// Messages between this program and a serving program, over its standard streams.
///
/// methods/exchange.md describes them.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "harness/sweep/catalogue/exchange.hpp"
#include "methods/incremental.hpp"

namespace loopbench::harness {

struct MessageHeader {
  char magic[8] = {'L', 'B', 'E', 'X', 'C', 'H', '0', '1'};
  std::uint64_t number = 0;
  std::uint64_t text = 0;  ///< [bytes]
  std::uint64_t data = 0;  ///< [bytes]
};
static_assert(sizeof(MessageHeader) == 32);

/// A request with arrays of poses and edges, whose shapes are added to `text`. O(n).
std::string request(nlohmann::json text,
                    const std::vector<std::pair<std::string, const Trajectory*>>& poses,
                    const std::vector<std::pair<std::string, const std::vector<Edge>*>>& edges,
                    std::uint64_t number);

/// The complete bytes of a request. O(keyframes + frames + edges).
std::string request(const Problem& problem, ResultPoses output, std::uint64_t number);

/// The bytes of a request with what has arrived in a replay since update `update` - 1; 0 begins
/// one. O(new data).
std::string request(const methods::Increment& added,
                    std::size_t update,
                    bool planar,
                    std::uint64_t number);

/// Throws std::runtime_error if the header of an answer is not one, has another number, or states
/// sizes beyond the limits.
void check_header(const MessageHeader& header, std::uint64_t number, std::size_t keyframes);

/// Poses of an answer; its metadata are written to `metadata`. Throws std::runtime_error, and
/// Undefined if the program declined.
Trajectory answer_poses(const std::string& text, const std::string& data, ResultMetadata& metadata);

}  // namespace loopbench::harness
