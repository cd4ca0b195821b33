/// Files as readers see them: plain, compressed, or from a pipe.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

#include "datasets/core/error.hpp"

namespace loopbench {

/// A file that can be opened any number of times. The content of compressed files, pipes and
/// standard input is kept in memory.
struct OpenedFile {
  std::string name;                      ///< as given, for messages
  std::string path;                      ///< to open; valid as long as `memory`
  std::size_t size = 0;                  ///< [bytes]
  std::shared_ptr<const void> memory{};  ///< null for plain files

  InputError error(const std::string& what) const { return input_error(name, 0, what); }
};

/// Whether the file is a pipe with a name, where opening waits for a writer. Pipes that a shell has
/// connected (/dev/stdin, /dev/fd/N) are none.
bool is_named_pipe(const std::filesystem::path& file);

/// Opens a regular file, a pipe of the shell (`<(COMMAND)`) or standard input (`-`). gzip, bzip2,
/// zstd, lz4, xz and zip archives of one file are detected from the first bytes and decompressed; a
/// pipe is read once, and
/// opening it again returns the same content. Throws InputError for a file that is missing, empty,
/// of another kind (also a named pipe, where opening would wait for a writer), unreadable, larger
/// than 8 GiB (`limit` bytes) or damaged, where `expected` states what is accepted ("a text file");
/// for pipes and decompressed files of more than 2 GiB, and for compressed files that expand to
/// more than 64 MiB and 50 times their size. Throws MissingPart if the build lacks the libraries.
/// Thread-safe.
OpenedFile open_input(const std::filesystem::path& file,
                      const std::string& expected = "a text file",
                      std::size_t limit = std::size_t{8} << 30);

/// Returns all bytes of a file that the user names, as open_input() accepts it. Throws InputError
/// as that does, where `what` is the expected content, and for more than `most` bytes.
std::string read_named_file(const std::filesystem::path& file,
                            std::size_t most,
                            const std::string& what);

}  // namespace loopbench
