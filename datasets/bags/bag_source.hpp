/// Bytes of a bag: a file read through a window, or a decompressed chunk.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

#include "datasets/compressed/input_file.hpp"

namespace loopbench {

class BagSource {
 public:
  explicit BagSource(const OpenedFile& file);

  std::uint64_t size() const { return size_; }

  /// Bytes [at, at + count), valid until the next call. Throws DamagedRecord if the file ends
  /// before, InputError if it cannot be read.
  std::string_view bytes(std::uint64_t at, std::uint64_t count);

 private:
  struct CloseHandle {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  OpenedFile file_;
  std::uint64_t size_ = 0;
  std::unique_ptr<std::FILE, CloseHandle> handle_;
  std::uint64_t begin_ = 0;  ///< file offset of the window
  std::string window_;
};

}  // namespace loopbench
