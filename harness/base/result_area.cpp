#include "harness/base/result_area.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cstring>
#include <new>
#include <stdexcept>

#include "harness/base/hash.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kCapacity = std::size_t{256} << 20;  // [bytes], used only as far as written
constexpr std::size_t kKept = std::size_t{1} << 20;        // [bytes], not returned to the system

}  // namespace

struct ResultArea::Header {
  std::size_t size = 0;
  Hash hash;
  pid_t writer = 0;

  char* bytes() { return reinterpret_cast<char*>(this + 1); }
};

ResultArea::ResultArea() {
  constexpr int kFlags = MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE;
  void* memory = mmap(nullptr, kCapacity, PROT_READ | PROT_WRITE, kFlags, -1, 0);
  if (memory == MAP_FAILED) throw std::runtime_error("cannot map the memory for results");
  header_ = new (memory) Header;
}

ResultArea::~ResultArea() { munmap(header_, kCapacity); }

void ResultArea::clear() {
  if (header_->size == 0 || header_->size > kKept) {  // after a failure it can have been filled
    madvise(reinterpret_cast<char*>(header_) + kKept, kCapacity - kKept, MADV_REMOVE);
  }
  *header_ = {};
}

bool ResultArea::write(std::string_view bytes) {
  if (bytes.size() > kCapacity - sizeof(Header)) return false;
  std::memcpy(header_->bytes(), bytes.data(), bytes.size());
  header_->hash = hash_of(bytes);
  header_->writer = getpid();
  header_->size = bytes.size();
  return true;
}

std::optional<std::string_view> ResultArea::read(pid_t writer) const {
  const std::size_t size = header_->size;
  if (header_->writer != writer || size == 0 || size > kCapacity - sizeof(Header))
    return std::nullopt;
  const std::string_view bytes(header_->bytes(), size);
  if (hash_of(bytes) != header_->hash) return std::nullopt;
  return bytes;
}

}  // namespace loopbench::harness
