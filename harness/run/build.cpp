#include "harness/run/build.hpp"

#include <gnu/libc-version.h>

#include <sstream>

#include "harness/base/hash.hpp"
#include "harness/catalogue/libraries.hpp"

namespace loopbench::harness {

std::string build_id(const std::string& code) {
  Fields fields;
  fields.add(code);
  for (const auto& [name, value] : build_metadata()) fields.add(name).add(value);
  for (const std::filesystem::path& library : program_libraries()) {
    fields.add(library.filename().string());
  }
  return fields.add(gnu_get_libc_version()).hashed().substr(0, 16);
}

std::string build_summary(const std::map<std::string, std::string>& provenance) {
  const auto value_of = [&](const std::string& name, std::size_t most = std::string::npos) {
    const auto found = provenance.find(name);
    std::istringstream lines(found == provenance.end() ? "unknown" : found->second);
    std::string out;
    for (std::string line; std::getline(lines, line);) {
      out += (out.empty() ? "" : " / ") + line.substr(0, most);
    }
    return out;
  };
  constexpr std::size_t kShort = 12;  // unambiguous prefix of a commit
  return "loopbench " + value_of("version") + " (" + value_of("commit", kShort) + ", " +
         value_of("source") + "), " + value_of("compiler") + ", " + value_of("flags") + "; " +
         value_of("cpu") + ", " + value_of("kernel");
}

}  // namespace loopbench::harness
