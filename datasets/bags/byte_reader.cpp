#include "datasets/bags/byte_reader.hpp"

#include <sys/types.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace loopbench {

BagSource::BagSource(const OpenedFile& file)
    : file_(file), size_(file.size), handle_(std::fopen(file.path.c_str(), "rb")) {
  if (!handle_) throw file_.error(std::string("cannot be read: ") + std::strerror(errno));
  std::setvbuf(handle_.get(), nullptr, _IONBF, 0);
}

std::string_view BagSource::bytes(std::uint64_t at, std::uint64_t count) {
  constexpr std::uint64_t kWindow = std::uint64_t{64} << 10;  // [bytes]
  if (at > size_ || count > size_ - at) throw DamagedRecord("ends early");
  if (at < begin_ || at + count > begin_ + window_.size()) {
    window_.resize(static_cast<std::size_t>(std::min(std::max(count, kWindow), size_ - at)));
    begin_ = at;
    const bool is_read =
        fseeko(handle_.get(), static_cast<off_t>(at), SEEK_SET) == 0 &&
        std::fread(window_.data(), 1, window_.size(), handle_.get()) == window_.size();
    if (!is_read) {
      window_.clear();
      throw file_.error("cannot be read completely");
    }
  }
  return std::string_view(window_).substr(static_cast<std::size_t>(at - begin_),
                                          static_cast<std::size_t>(count));
}

}  // namespace loopbench
