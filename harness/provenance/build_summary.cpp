#include "harness/provenance/build_summary.hpp"

#include <sstream>

namespace loopbench::harness {

std::string build_summary(const std::map<std::string, std::string>& provenance) {
  const auto fact = [&](const std::string& name, std::size_t most = std::string::npos) {
    const auto found = provenance.find(name);
    std::istringstream lines(found == provenance.end() ? "unknown" : found->second);
    std::string out;
    for (std::string line; std::getline(lines, line);) {
      out += (out.empty() ? "" : " / ") + line.substr(0, most);
    }
    return out;
  };
  constexpr std::size_t kShort = 12;  // unambiguous prefix of a commit
  return "loopbench " + fact("version") + " (" + fact("commit", kShort) + ", " + fact("source") +
         "), " + fact("compiler") + ", " + fact("flags") + "; " + fact("cpu") + ", " +
         fact("kernel");
}

}  // namespace loopbench::harness
