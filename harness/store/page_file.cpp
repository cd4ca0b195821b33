#include "harness/store/page_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>

#include "datasets/core/error.hpp"
#include "harness/store/big_endian.hpp"

namespace loopbench::harness {
namespace {

constexpr std::uint32_t kDefaultPageSize = 4096;
constexpr std::uint64_t kLogHeader = 32;
constexpr std::uint64_t kFrameHeader = 24;

/// Number of bytes read, fewer at the end of the file or at an unreadable sector.
std::size_t read_at(int file, std::uint64_t offset, char* out, std::size_t size) {
  std::size_t done = 0;
  while (done < size) {
    const ssize_t count = pread(file, out + done, size - done, static_cast<off_t>(offset + done));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    done += static_cast<std::size_t>(count);
  }
  return done;
}

std::uint64_t size_of(int file) {
  struct stat found {};
  return fstat(file, &found) == 0 ? static_cast<std::uint64_t>(found.st_size) : 0;
}

bool is_page_size(std::uint32_t size) {
  return size >= 512 && size <= 65536 && std::has_single_bit(size);
}

/// Cumulative checksum of the log, over pairs of 32-bit words.
struct LogChecksum {
  bool big_endian_words = false;
  std::uint32_t first = 0;
  std::uint32_t second = 0;

  void add(const char* data, std::size_t size) {
    for (std::size_t i = 0; i + 8 <= size; i += 8) {
      first += word(data + i) + second;
      second += word(data + i + 4) + first;
    }
  }
  bool matches(const char* data) const {
    return big_endian_32(data) == first && big_endian_32(data + 4) == second;
  }

 private:
  std::uint32_t word(const char* data) const {
    const std::uint32_t value = big_endian_32(data);
    return big_endian_words ? value : __builtin_bswap32(value);
  }
};

void set_location(PageView& view, std::uint32_t page, std::uint64_t offset) {
  if (page > view.pages.size()) view.pages.resize(page);
  view.pages[page - 1] = {true, offset};
}

}  // namespace

PageFile::PageFile(const std::filesystem::path& file)
    : file_(open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
  if (file_ < 0) throw InputError(file.string() + ": cannot be opened: " + std::strerror(errno));
  file_bytes_ = size_of(file_);
  log_ = open((file.string() + "-wal").c_str(), O_RDONLY | O_CLOEXEC);
  if (log_ >= 0) log_bytes_ = size_of(log_);
}

PageFile::~PageFile() {
  close(file_);
  if (log_ >= 0) close(log_);
}

std::vector<std::uint32_t> PageFile::page_sizes() const {
  std::vector<std::uint32_t> out;
  const auto add = [&](std::uint32_t size) {
    if (is_page_size(size) && std::ranges::count(out, size) == 0) out.push_back(size);
  };
  std::array<char, 18> header{};
  read_at(file_, 0, header.data(), header.size());
  if (std::memcmp(header.data(), "SQLite format 3", 16) == 0) {
    const std::uint32_t size = big_endian_16(header.data() + 16);
    add(size == 1 ? 65536 : size);
  }
  add(kDefaultPageSize);
  return out;
}

std::vector<PageView> PageFile::views() const {
  std::vector<PageView> out;
  const auto add = [&](PageView view) {
    if (!view.pages.empty() && std::ranges::count(out, view) == 0) out.push_back(std::move(view));
  };
  std::array<char, kLogHeader> header{};
  read_at(log_, 0, header.data(), header.size());
  for (const std::uint32_t size : page_sizes()) {
    PageView file{size, {}};
    file.pages.resize((file_bytes_ + size - 1) / size);
    for (std::size_t i = 0; i < file.pages.size(); ++i) file.pages[i].offset = i * size;
    const std::uint64_t frame_bytes = kFrameHeader + size;
    const std::uint64_t frames =
        log_bytes_ < kLogHeader ? 0 : (log_bytes_ - kLogHeader) / frame_bytes;
    const std::uint64_t most_pages = file.pages.size() + frames;

    const std::uint32_t magic = big_endian_32(header.data());
    LogChecksum sum{(magic & 1u) != 0};
    sum.add(header.data(), 24);
    bool valid = (magic | 1u) == 0x377f0683 && sum.matches(header.data() + 24);
    std::array<char, 8> salts{};  // distinguish the frames from those of earlier logs
    if (valid) {
      std::memcpy(salts.data(), header.data() + 16, salts.size());
    } else {
      read_at(log_, kLogHeader + 8, salts.data(), salts.size());
    }
    PageView all = file;
    std::vector<std::uint32_t> valid_pages;
    std::size_t committed = 0;  // number of valid frames up to the last commit
    std::string frame(frame_bytes, '\0');
    for (std::uint64_t i = 0; i < frames; ++i) {
      const std::uint64_t offset = kLogHeader + i * frame_bytes;
      if (read_at(log_, offset, frame.data(), frame.size()) < frame.size()) {
        valid = false;
        continue;
      }
      const std::uint32_t page = big_endian_32(frame.data());
      if (std::memcmp(frame.data() + 8, salts.data(), salts.size()) != 0 || page == 0 ||
          page > most_pages) {
        valid = false;
        continue;
      }
      set_location(all, page, offset + kFrameHeader);
      sum.add(frame.data(), 8);
      sum.add(frame.data() + kFrameHeader, size);
      valid = valid && sum.matches(frame.data() + 16);
      if (!valid) continue;
      valid_pages.push_back(page);
      if (big_endian_32(frame.data() + 4) != 0) committed = valid_pages.size();
    }
    add(std::move(all));
    PageView as_committed = file;
    for (std::size_t i = 0; i < committed; ++i) {
      set_location(as_committed, valid_pages[i], kLogHeader + i * frame_bytes + kFrameHeader);
    }
    add(std::move(as_committed));
    add(std::move(file));
  }
  return out;
}

bool PageFile::read(const PageView& view, std::uint32_t number, std::string& page) const {
  if (number == 0 || number > view.pages.size()) return false;
  const PageView::Location& place = view.pages[number - 1];
  page.assign(view.page_size, '\0');
  return read_at(place.in_log ? log_ : file_, place.offset, page.data(), page.size()) > 0;
}

}  // namespace loopbench::harness
