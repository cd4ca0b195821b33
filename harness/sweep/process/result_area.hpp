/// Shared memory in which a cell leaves its result for its worker.
#pragma once

#include <sys/mman.h>
#include <sys/types.h>
#include <unistd.h>

#include <cstddef>
#include <cstdio>
#include <cstring>
#include <new>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "harness/sweep/process/system_file.hpp"
#include "harness/sweep/text/hash.hpp"

namespace loopbench::harness {

/// Created by the worker, inherited by its cells. Needs no descriptor that a method could close,
/// and a method that writes into it only loses its own result.
class ResultArea {
 public:
  /// Throws std::runtime_error if it cannot be mapped.
  ResultArea() : capacity_(most_bytes()) {
    constexpr int kFlags = MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE;
    const auto map = [&] {
      return mmap(nullptr, capacity_, PROT_READ | PROT_WRITE, kFlags, -1, 0);
    };
    void* memory = map();
    for (; memory == MAP_FAILED && capacity_ > 2 * kKept; memory = map()) capacity_ /= 2;
    if (memory == MAP_FAILED) throw std::runtime_error("cannot map the memory for results");
    header_ = new (memory) Header;
  }
  ~ResultArea() { munmap(header_, capacity_); }
  ResultArea(const ResultArea&) = delete;
  ResultArea& operator=(const ResultArea&) = delete;

  /// Before a cell is forked.
  void clear() {
    if (header_->size == 0 || header_->size > kKept) {  // after a failure it can have been filled
      madvise(reinterpret_cast<char*>(header_) + kKept, capacity_ - kKept, MADV_REMOVE);
    }
    *header_ = {};
  }

  /// False, with a message on standard error, if there are too many bytes.
  bool write(std::string_view bytes) {
    if (bytes.size() > capacity_ - sizeof(Header)) {
      std::fprintf(stderr, "a result of %zu bytes exceeds %zu bytes\n", bytes.size(), capacity_);
      return false;
    }
    std::memcpy(header_->bytes(), bytes.data(), bytes.size());
    header_->hash = hash_of(bytes);
    header_->writer = getpid();
    header_->size = bytes.size();
    return true;
  }

  /// nullopt unless `writer` wrote a complete result, which is unchanged. Valid until clear().
  std::optional<std::string_view> read(pid_t writer) const {
    const std::size_t size = header_->size;
    if (header_->writer != writer || size == 0 || size > capacity_ - sizeof(Header))
      return std::nullopt;
    const std::string_view bytes(header_->bytes(), size);
    if (hash_of(bytes) != header_->hash) return std::nullopt;
    return bytes;
  }

 private:
  static constexpr std::size_t kKept = std::size_t{1} << 20;  // [bytes], not returned to the system

  struct Header {
    std::size_t size = 0;
    Hash hash;
    pid_t writer = 0;

    char* bytes() { return reinterpret_cast<char*>(this + 1); }
  };

  /// A sequence of ten million poses with edges has 6 GiB. A system that grants no memory on credit
  /// would reserve it for each worker.
  static std::size_t most_bytes() {
    const bool has_credit = !read_system_file("/proc/sys/vm/overcommit_memory").starts_with('2');
    return std::size_t{has_credit ? 16384u : 256u} << 20;
  }

  std::size_t capacity_;  ///< [bytes], used only as far as written
  Header* header_ = nullptr;
};

}  // namespace loopbench::harness
