#include "harness/commands/download.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <system_error>

#include "datasets/core/error.hpp"
#include "harness/base/run_filter.hpp"

namespace loopbench::harness {
namespace {

namespace fs = std::filesystem;

constexpr int kNoRange = 33;    ///< of curl: the server cannot continue a download
constexpr int kHttpError = 22;  ///< of curl

/// Starts a program without a shell.
FilterResult run_installed(const std::vector<std::string>& words, const std::string& package) {
  try {
    return run_filter(words);
  } catch (const std::system_error&) {
    throw InputError("get: the program " + words[0] + " is not installed (Debian package " +
                     package + ")");
  }
}

int curl(const std::string& url, const fs::path& part) {
  return run_installed({"curl",
                        "--fail",
                        "--location",
                        "--proto",  // "=": also after redirections
                        "=http,https",
                        isatty(STDERR_FILENO) == 1 ? "--progress-bar" : "--silent",
                        "--show-error",
                        "--continue-at",
                        "-",
                        "--output",
                        part.string(),
                        "--",
                        url},
                       "curl")
      .exit_code;
}

/// Downloads to `part`, continuing it if possible.
void download_part(const PublicFile& wanted, const fs::path& part) {
  int code = curl(wanted.url, part);
  if (code == kNoRange) {
    fs::remove(part);
    code = curl(wanted.url, part);
  }
  // A part that is already complete has nothing to continue: HTTP 416.
  const bool may_be_complete = code == kHttpError && fs::exists(part);
  if (code != 0 && !may_be_complete) {
    throw InputError(fmt::format(
        "{}: curl failed with exit code {}; run the command again to continue", wanted.url, code));
  }
}

}  // namespace

std::string sha256_of_file(const fs::path& file) {
  constexpr std::size_t kDigits = 64;
  const FilterResult result =
      run_installed({"sha256sum", "--zero", "--", file.string()}, "coreutils");
  if (result.exit_code != 0) throw InputError(file.string() + ": cannot be read");
  return result.output.substr(0, kDigits);
}

Fetched fetch(const PublicFile& wanted, const fs::path& folder) {
  const fs::path file = folder / wanted.file;
  if (fs::exists(file)) {
    const std::string found = sha256_of_file(file);
    if (found == wanted.sha256) return Fetched::present;
    throw InputError(
        fmt::format("{}: its SHA-256 is {}, expected {}; remove the file to download it again",
                    file.string(),
                    found,
                    wanted.sha256));
  }
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  if (error)
    throw InputError(file.parent_path().string() + ": cannot be created: " + error.message());
  const fs::path part = file.string() + ".part";
  download_part(wanted, part);
  const std::string found = sha256_of_file(part);
  if (found != wanted.sha256) {
    fs::remove(part);
    throw InputError(
        fmt::format("{}: the content has changed and was rejected: its SHA-256 is {}, expected {}",
                    wanted.url,
                    found,
                    wanted.sha256));
  }
  fs::rename(part, file, error);
  if (error) throw InputError(file.string() + ": cannot be written: " + error.message());
  return Fetched::downloaded;
}

}  // namespace loopbench::harness
