#include "harness/run/collect_provenance.hpp"

#include <gnu/libc-version.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <fstream>
#include <set>
#include <sstream>
#include <thread>

#include "harness/catalogue/libraries.hpp"
#include "harness/catalogue/load_sequence.hpp"
#include "harness/run/build.hpp"

namespace loopbench::harness {
namespace {

/// The first "model name" of /proc/cpuinfo, which exists only on PCs.
std::string cpu_name() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string kernel_name() {
  utsname name{};
  if (uname(&name) != 0) return "unknown";
  return std::string(name.sysname) + " " + name.release + " " + name.machine;
}

std::string seeds(const Sweep& sweep, const Catalogue& catalogue) {
  std::string out;
  for (const DatasetChoice& choice : sweep.datasets) {
    const DatasetEntry& entry = find_dataset(catalogue, choice.dataset.name);
    std::string line;
    for (int repeat = 0; repeat < sweep.repeats; ++repeat) {
      const Params options = full_options(choice, entry, repeat);
      if (const auto seed = options.find("seed"); seed != options.end()) {
        line += " " + to_text(seed->second);
      }
    }
    if (!line.empty()) out += choice.label + ":" + line + "\n";
  }
  return out;
}

}  // namespace

std::string instruction_set() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    const bool is_list = line.starts_with("flags") || line.starts_with("Features");
    const std::size_t colon = line.find(':');
    if (!is_list || colon == std::string::npos) continue;
    std::istringstream words(line.substr(colon + 1));
    std::set<std::string> found;
    for (std::string word; words >> word;) found.insert(word);
    std::string out;
    for (const char* name : {"sse4_2",
                             "avx",
                             "avx2",
                             "fma",
                             "fma4",
                             "f16c",
                             "avx512f",
                             "avx512dq",
                             "avx512bw",
                             "avx512vl",
                             "avx512_vnni",
                             "asimd",
                             "sve",
                             "sve2"}) {
      if (found.contains(name)) out += (out.empty() ? "" : " ") + std::string(name);
    }
    return out.empty() ? "none of those by which libraries choose" : out;
  }
  return "unknown";
}

std::map<std::string, std::string> provenance(const Source& source,
                                              const Sweep& sweep,
                                              const Catalogue& catalogue) {
  std::map<std::string, std::string> out;
  for (const auto& [name, value] : build_metadata()) out.emplace(name, value);
  out["commit"] = source.commit;
  out["source"] = source.state;
  out["build"] = build_id(source.code);
  out["c library"] = std::string("glibc ") + gnu_get_libc_version();
  std::string libraries;
  for (const std::filesystem::path& library : program_libraries()) {
    libraries += library.filename().string() + "\n";
  }
  out["libraries"] = libraries;
  out["cpu"] = cpu_name();
  out["instructions"] = instruction_set();
  out["cores"] = std::to_string(std::thread::hardware_concurrency());
  const std::int64_t memory =
      std::int64_t{sysconf(_SC_PHYS_PAGES)} * std::int64_t{sysconf(_SC_PAGESIZE)};
  out["memory [bytes]"] = std::to_string(memory);
  out["kernel"] = kernel_name();
  out["seeds"] = seeds(sweep, catalogue);
  std::string plugins;
  for (const auto& [entry, version] : catalogue.versions) {
    plugins += entry + ": " + version + "\n";
  }
  out["plugins"] = plugins;
  return out;
}

}  // namespace loopbench::harness
