/// Shared memory in which a cell leaves its result for its worker.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <optional>
#include <string_view>

namespace loopbench::harness {

/// Created by the worker, inherited by its cells. Needs no descriptor that a method could close,
/// and a method that writes into it only loses its own result.
class ResultArea {
 public:
  ResultArea();  ///< throws std::runtime_error if it cannot be mapped
  ~ResultArea();
  ResultArea(const ResultArea&) = delete;
  ResultArea& operator=(const ResultArea&) = delete;

  /// Before a cell is forked.
  void clear();

  /// False if there are too many bytes.
  bool write(std::string_view bytes);

  /// nullopt unless `writer` wrote a complete result, which is unchanged. Valid until clear().
  std::optional<std::string_view> read(pid_t writer) const;

 private:
  struct Header;

  Header* header_ = nullptr;
};

}  // namespace loopbench::harness
