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
  std::string sha256;          ///< 64 hexadecimal digits
  std::filesystem::path file;  ///< relative to the data folder
  std::string summary;
};

/// The catalogue that the program contains.
std::vector<PublicFile> public_files();

/// 64 hexadecimal digits, by the program sha256sum. Throws InputError.
std::string sha256_of_file(const std::filesystem::path& file);

/// Where a file with the expected hash comes from.
enum class Fetched { present, downloaded };

/// Downloads into `folder` with the program curl. An interrupted download continues (FILE.part) if
/// the server supports that. A download with another hash is removed. Throws InputError if the file
/// cannot be downloaded, written or verified; a file that is already there is never overwritten.
Fetched fetch(const PublicFile& wanted, const std::filesystem::path& folder);

}  // namespace loopbench::harness
