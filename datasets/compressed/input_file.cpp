#include "datasets/compressed/input_file.hpp"

#include <fcntl.h>
#include <linux/magic.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <map>
#include <mutex>
#include <system_error>
#include <utility>

#include "datasets/compressed/decompress.hpp"
#include "datasets/compressed/zip.hpp"
#include "datasets/files/closest_name.hpp"
#include "datasets/files/regular_file.hpp"

namespace loopbench {
namespace {

constexpr std::size_t kMagicBytes = 8;

/// Largest content of a pipe or of a compressed file, which are kept in memory [bytes].
constexpr std::size_t kMostInMemory = std::size_t{2} << 30;
/// Expansion that is permitted for every compressed file [bytes].
constexpr std::size_t kAnyExpansion = std::size_t{64} << 20;
/// Largest expansion of longer files, relative to their size: pose files reach about 10.
constexpr std::size_t kMostExpansion = 50;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using FileHandle = std::unique_ptr<std::FILE, CloseFile>;

InputError unreadable(const std::string& name) {
  return input_error(name, 0, std::string("cannot be read: ") + std::strerror(errno));
}

FileHandle opened(const std::string& name, const std::string& path) {
  FileHandle handle(path == "-" ? fdopen(dup(STDIN_FILENO), "rb") : std::fopen(path.c_str(), "rb"));
  if (!handle) throw unreadable(name);
  return handle;
}

/// Reads to the end, at most `limit` bytes.
std::string all_of(std::FILE* file, const std::string& name, std::size_t limit) {
  std::string out;
  std::array<char, 65536> buffer;
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), file)) {
    out.append(buffer.data(), count);
    if (out.size() > limit) {
      throw input_error(name, 0, "is longer than " + std::to_string(limit) + " bytes");
    }
  }
  if (std::ferror(file) != 0) throw unreadable(name);
  return out;
}

/// An empty file in memory; `file` is set to its descriptor.
OpenedFile memory_file(const std::string& name, int& file) {
  file = memfd_create("loopbench", MFD_CLOEXEC);
  if (file < 0) throw unreadable(name);
  std::shared_ptr<const void> closes(new int(file), [](const int* descriptor) {
    close(*descriptor);
    delete descriptor;
  });
  return {name, "/proc/self/fd/" + std::to_string(file), 0, std::move(closes)};
}

/// The only file of a zip archive.
std::string only_member(const std::string& name, std::string_view archive, std::size_t limit) {
  std::vector<ZipMember> members = zip_members(archive, limit);
  if (members.size() == 1) return std::move(members.front().content);
  std::string names;
  for (const ZipMember& member : members) names += (names.empty() ? "" : ", ") + member.name;
  throw input_error(name,
                    0,
                    "is a zip archive of " + std::to_string(members.size()) +
                        " files, expected one (" + names + ")");
}

/// The content in memory, decompressed if it is compressed.
OpenedFile expanded(const std::string& name, const std::string& content, std::size_t limit) {
  int file = -1;
  OpenedFile out = memory_file(name, file);
  const auto append = [&](std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t count = write(file, bytes.data(), bytes.size());
      if (count < 0) throw unreadable(name);
      bytes.remove_prefix(static_cast<std::size_t>(count));
      out.size += static_cast<std::size_t>(count);
    }
  };
  const std::optional<Codec> codec = codec_of(content);
  if (!codec && !is_zip(content)) {
    append(content);
    return out;
  }
  const std::size_t most =
      std::min({limit, kMostInMemory, std::max(kAnyExpansion, kMostExpansion * content.size())});
  try {
    if (codec) {
      decompress(*codec, content, most, append);
    } else {
      append(only_member(name, content, most));
    }
  } catch (const ExpandsTooFar& reason) {
    throw input_error(name,
                      0,
                      std::string(reason.what()) + " (limits: 2 GiB, and 50 times its size or " +
                          "64 MiB): decompress it first");
  } catch (const DamagedStream& damage) {
    throw input_error(name, 0, std::string("cannot be decompressed: ") + damage.what());
  }
  return out;
}

/// Content of pipes, which can be read only once.
OpenedFile from_pipe(const std::string& name, std::size_t limit) {
  static std::mutex mutex;
  static std::map<std::pair<std::string, ino_t>, OpenedFile> read;
  struct stat status {};
  if (stat(name == "-" ? "/dev/stdin" : name.c_str(), &status) != 0) throw unreadable(name);
  const std::lock_guard lock(mutex);
  const std::pair key(name, status.st_ino);  // numbers of descriptors are used again
  const auto known = read.find(key);
  if (known != read.end()) return known->second;
  const std::string content =
      all_of(opened(name, name).get(), name, std::min(limit, kMostInMemory));
  return read.emplace(key, expanded(name, content, limit)).first->second;
}

/// The last decompressed file: readers detect the format first and open the file again.
OpenedFile from_compressed(const OpenedFile& file, std::size_t limit) {
  struct Kept {
    std::string name;
    std::filesystem::file_time_type written;
    std::size_t size = 0;
    OpenedFile content;
  };
  static std::mutex mutex;
  static Kept kept;
  const std::lock_guard lock(mutex);
  std::error_code ignored;
  const auto written = std::filesystem::last_write_time(file.path, ignored);
  if (kept.name == file.name && kept.written == written && kept.size == file.size) {
    return kept.content;
  }
  const std::string content =
      all_of(opened(file.name, file.path).get(), file.name, std::min(limit, kMostInMemory));
  kept = {file.name, written, file.size, expanded(file.name, content, limit)};
  return kept.content;
}

}  // namespace

bool is_named_pipe(const std::filesystem::path& file) {
  struct stat status {};
  struct statfs system {};
  return ::stat(file.c_str(), &status) == 0 && S_ISFIFO(status.st_mode) &&
         ::statfs(file.c_str(), &system) == 0 && system.f_type != PIPEFS_MAGIC;
}

OpenedFile open_input(const std::filesystem::path& file,
                      const std::string& expected,
                      std::size_t limit) {
  OpenedFile out{file.string(), file.string()};
  if (file == "-") {
    out = from_pipe("-", limit);
    out.name = "standard input";
  } else {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (status.type() == std::filesystem::file_type::not_found) {
      throw out.error("no such file" + similar_file(file));
    }
    if (error) throw out.error("cannot be read: " + error.message());
    if (std::filesystem::is_directory(status)) {
      throw out.error("is a directory, expected " + expected);
    }
    if (is_named_pipe(file)) throw out.error("is a named pipe, expected " + expected);
    if (std::filesystem::is_fifo(status)) {
      out = from_pipe(out.name, limit);
    } else if (!std::filesystem::is_regular_file(status)) {
      throw out.error("is not a regular file, expected " + expected);
    } else {
      out.size = static_cast<std::size_t>(std::filesystem::file_size(file, error));
      if (error) throw out.error("cannot be read: " + error.message());
    }
  }
  if (out.size == 0) throw out.error("is empty");
  if (out.size > limit) {
    throw out.error("has " + std::to_string(out.size) + " bytes, expected at most " +
                    std::to_string(limit));
  }
  if (out.memory) return out;
  std::array<char, kMagicBytes> magic{};
  const std::size_t count =
      std::fread(magic.data(), 1, magic.size(), opened(out.name, out.path).get());
  const std::string_view start(magic.data(), count);
  return codec_of(start) || is_zip(start) ? from_compressed(out, limit) : out;
}

std::string read_named_file(const std::filesystem::path& file,
                            std::size_t most,
                            const std::string& what) {
  if (!std::filesystem::exists(file)) {
    throw input_error(file.string(), 0, "no such file, expected " + what + similar_file(file));
  }
  const OpenedFile in = open_input(file, what, most);
  return read_regular_file(in.path, most, "file");
}

}  // namespace loopbench
