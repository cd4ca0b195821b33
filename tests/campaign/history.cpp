#include "tests/campaign/history.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <thread>

#include "harness/store/stored_cells.hpp"
#include "tests/support/store_text.hpp"

namespace loopbench::campaign {
namespace {

constexpr std::chrono::milliseconds kGrace{15000};  // for processes that end by themselves

std::string joined(const std::set<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ", ") + word;
  return out;
}

std::vector<std::string> sweep_words(const Settings& settings, const std::filesystem::path& out) {
  std::vector<std::string> words{
      settings.binary, "run", settings.config, "--out", out, "--jobs", "3"};
  for (const std::filesystem::path& plugin : settings.plugins) {
    words.insert(words.end(), {"--plugin", plugin});
  }
  return words;
}

std::set<std::string> labels_of_store(const std::filesystem::path& store) {
  std::set<std::string> out;
  for (const harness::CellRecord& cell : harness::read_cells(store)) {
    out.insert(harness::label_of(cell));
  }
  return out;
}

/// Without the sizes of the sequences' traces, which a repair can lose.
std::string comparable_text(const std::filesystem::path& store) {
  std::istringstream in(store_text(store));
  std::string out;
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("sequence ")) out += line + "\n";
  }
  return out;
}

}  // namespace

History::History(const Settings& settings, const Undisturbed& undisturbed, std::uint64_t seed)
    : random(seed),
      settings_(settings),
      undisturbed_(undisturbed),
      folder_(settings.folder / "history"),
      out_(folder_ / "out") {
  std::filesystem::remove_all(folder_);
  std::filesystem::create_directories(out_);
}

std::vector<std::string> History::run_words(const std::vector<std::string>& more,
                                            const std::filesystem::path& out) const {
  std::vector<std::string> words = sweep_words(settings_, out.empty() ? out_ : out);
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

int History::command(const std::vector<std::string>& words,
                     const std::set<int>& codes,
                     std::uint64_t file_limit) {
  Child child(words, path("output"), file_limit);
  return ended(child, codes);
}

int History::ended(Child& child, const std::set<int>& codes) {
  const int code = child.wait(settings_.limit);
  if (code == -1) throw Broken("hangs: " + output());
  const std::vector<std::string> left = left_processes(kGrace);
  if (!left.empty()) throw Broken("leaves " + std::to_string(left.size()) + ": " + left.front());
  if (codes.contains(code)) return code;
  throw Broken("exit code " + std::to_string(code) + ": " + output());
}

void History::sleep_some() {
  // Also before the first cell and while the tables are written.
  const double share = 1.2 * static_cast<double>(random() % 1000) / 1000.0;
  std::this_thread::sleep_for(share * undisturbed_.takes);
}

std::set<std::string> History::cells(const std::filesystem::path& store) const {
  if (!std::filesystem::exists(store) || (std::filesystem::file_size(store) == 0 &&
                                          !std::filesystem::exists(store.string() + "-wal"))) {
    return {};
  }
  try {
    return labels_of_store(store);
  } catch (const InputError& error) {
    // A process killed before the tables were created leaves an empty database.
    if (std::string(error.what()).find("schema 0") != std::string::npos) return {};
    throw Broken(error.what());
  }
}

void History::expect_kept(const std::filesystem::path& store,
                          const std::set<std::string>& before) const {
  const std::set<std::string> now = cells(store);
  std::set<std::string> lost;
  std::ranges::set_difference(before, now, std::inserter(lost, lost.end()));
  if (!lost.empty()) throw Broken(store.string() + " lost " + joined(lost));
}

void History::finish() {
  command(run_words(), {undisturbed_.exit_code});
  if (comparable_text(store()) != undisturbed_.text) {
    throw Broken(store().string() + " differs from the undisturbed store");
  }
  const std::regex expected(
      R"((results|previous-\d+)\.sqlite|table\.(md|csv)|rows\.csv|provenance\.json)");
  for (const auto& file : std::filesystem::directory_iterator(out_)) {
    const std::string name = file.path().filename();
    if (!std::regex_match(name, expected)) throw Broken("stray file " + file.path().string());
  }
  for (const auto& file : std::filesystem::directory_iterator(folder_)) {
    const std::string name = file.path().filename();
    if (name != "out" && name != "output") throw Broken("stray file " + file.path().string());
  }
}

std::string History::output() const {
  std::ifstream in(path("output"), std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  return text.substr(text.size() - std::min<std::size_t>(text.size(), 600));
}

Undisturbed undisturbed_sweep(const Settings& settings) {
  Undisturbed out;
  const std::filesystem::path folder = settings.folder / "undisturbed";
  const auto begin = std::chrono::steady_clock::now();
  Child child(sweep_words(settings, folder), settings.folder / "output");
  out.exit_code = child.wait(10 * settings.limit);
  out.takes = std::chrono::steady_clock::now() - begin;
  if (out.exit_code != 0 && out.exit_code != 1) throw Broken("the undisturbed sweep fails");
  out.text = comparable_text(folder / "results.sqlite");
  out.cells = labels_of_store(folder / "results.sqlite");
  return out;
}

}  // namespace loopbench::campaign
