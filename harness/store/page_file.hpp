/// Pages of a SQLite database and its write-ahead log, read without SQLite, so that damage in one
/// page hides no other page. Format: https://sqlite.org/fileformat.html
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace loopbench::harness {

/// Where the newest version of each page is; page numbers start at 1.
struct PageView {
  struct Location {
    bool in_log = false;
    std::uint64_t offset = 0;  ///< in the file [bytes]
    bool operator==(const Location&) const = default;
  };
  std::uint32_t page_size = 0;  ///< [bytes]
  std::vector<Location> pages;
  bool operator==(const PageView&) const = default;
};

class PageFile {
 public:
  /// Opens the database `file` and its log for reading; both stay unchanged. Throws InputError if
  /// the database cannot be opened.
  explicit PageFile(const std::filesystem::path& file);
  ~PageFile();
  PageFile(const PageFile&) = delete;
  PageFile& operator=(const PageFile&) = delete;

  /// Different views of the data, best first: with every page in the log, also behind damaged ones;
  /// with the committed part of the log, as SQLite reads it; without the log. If the header of the
  /// file is damaged, also for the default page size. O(bytes of the log).
  std::vector<PageView> views() const;

  /// Reads page `number` into `page`; false if there is no such page or the disk reports an error.
  /// The missing end of the last page is zero.
  bool read(const PageView& view, std::uint32_t number, std::string& page) const;

  std::uint64_t bytes() const { return file_bytes_ + log_bytes_; }

 private:
  struct Log;

  std::vector<std::uint32_t> page_sizes() const;

  int file_ = -1;
  int log_ = -1;  ///< -1: none
  std::uint64_t file_bytes_ = 0;
  std::uint64_t log_bytes_ = 0;
};

}  // namespace loopbench::harness
