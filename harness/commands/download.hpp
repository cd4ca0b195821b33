/// Verified downloads of public sequences.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace loopbench::harness {

/// One file of the catalogue.
struct PublicFile {
  std::string name;
  std::string url;
  std::string licence;
  std::string sha256;          ///< 64 hexadecimal digits; empty: pinned by the first download
  std::filesystem::path file;  ///< relative to the data folder
  std::string summary;
};

/// The catalogue that the program contains. Every entry has a hash.
std::vector<PublicFile> public_files();

/// A catalogue in YAML: a list of {name, url, licence, sha256, file, summary}. Throws InputError
/// `file:line:`.
std::vector<PublicFile> read_public_files(const std::filesystem::path& catalogue);

/// 64 hexadecimal digits, by the program sha256sum. Throws InputError.
std::string sha256_of_file(const std::filesystem::path& file);

/// The file in which the hash of a first download is kept, as sha256sum prints it.
std::filesystem::path pin_of(const std::filesystem::path& file);

enum class Fetched {
  present,     ///< the file was there and has the expected hash
  downloaded,  ///< with the expected hash
  pinned       ///< downloaded for the first time; its hash is now expected
};

/// Downloads into `folder` with the program curl. An interrupted download continues (FILE.part) if
/// the server supports that. The content must have the hash of the catalogue or, without one, that
/// of the first download; otherwise it is removed. Throws InputError if the file cannot be
/// downloaded, written or verified; a file that is already there is never overwritten.
Fetched fetch(const PublicFile& wanted, const std::filesystem::path& folder);

}  // namespace loopbench::harness
