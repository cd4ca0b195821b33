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

/// A dataset that asks for a registration, or of which no hash is known: it is downloaded by hand.
struct PublicPage {
  std::string name;
  std::string url;
  std::string file;  ///< the reference, which is read as it is
};
std::vector<PublicPage> public_pages();

/// 64 hexadecimal digits, by the program sha256sum. Throws InputError.
std::string sha256_of_file(const std::filesystem::path& file);

/// Where a file with the expected hash comes from.
enum class Fetched { present, downloaded };

/// Downloads into `folder` with the program curl. An interrupted download continues (FILE.part) if
/// the server supports that. A download with another hash is removed. Throws InputError if the file
/// cannot be downloaded, written or verified; a file that is already there is never overwritten.
Fetched fetch(const PublicFile& wanted, const std::filesystem::path& folder);

}  // namespace loopbench::harness
