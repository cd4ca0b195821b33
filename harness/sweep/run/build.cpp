#include "harness/sweep/run/build.hpp"

#include <gnu/libc-version.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <thread>

#include "harness/sweep/catalogue/libraries.hpp"
#include "harness/sweep/catalogue/load_sequence.hpp"
#include "harness/sweep/text/hash.hpp"

namespace loopbench::harness {
namespace {

/// What follows the colon of the first line of /proc/cpuinfo that begins with one of `names`.
std::string cpu_line(const std::vector<std::string>& names) {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    const std::size_t colon = line.find(':');
    const auto begins = [&](const std::string& name) { return line.starts_with(name); };
    if (colon != std::string::npos && std::ranges::any_of(names, begins)) {
      return line.substr(std::min(colon + 2, line.size()));
    }
  }
  return "";
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

std::string instruction_set() {
  std::istringstream words(cpu_line({"flags", "Features"}));
  const std::set<std::string> found(std::istream_iterator<std::string>(words), {});
  if (found.empty()) return "unknown";
  std::istringstream names(
      "sse4_2 avx avx2 fma fma4 f16c avx512f avx512dq avx512bw avx512vl avx512_vnni asimd sve "
      "sve2");
  std::string out;
  for (std::string name; names >> name;) {
    if (found.contains(name)) out += (out.empty() ? "" : " ") + name;
  }
  return out.empty() ? "none of those by which libraries choose" : out;
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
  const std::string cpu = cpu_line({"model name"});  // exists only on PCs
  out["cpu"] = cpu.empty() ? "unknown" : cpu;
  out["instructions"] = instruction_set();
  out["cores"] = std::to_string(std::thread::hardware_concurrency());
  const std::int64_t memory =
      std::int64_t{sysconf(_SC_PHYS_PAGES)} * std::int64_t{sysconf(_SC_PAGESIZE)};
  out["memory [bytes]"] = std::to_string(memory);
  out["kernel"] = kernel_name();
  out["seeds"] = seeds(sweep, catalogue);
  std::string plugins;
  for (const auto& [entry, version] : catalogue.versions) plugins += entry + ": " + version + "\n";
  out["plugins"] = plugins;
  return out;
}

}  // namespace loopbench::harness
