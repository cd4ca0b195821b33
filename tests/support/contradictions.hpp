/// Contradictions between the statements of `compare --format json`: the sentence, the groups, the
/// cautions and the numbers of the methods.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <string>
#include <vector>

namespace loopbench {

/// One comparison of a score of which lower values are better. Reads only the JSON.
class Contradictions {
 public:
  explicit Contradictions(const nlohmann::json& c)
      : c_(c), text_(c.at("verdict")), relevant_(c.at("relevant")), alpha_(c.at("alpha")) {
    for (const auto& m : c.at("methods")) by_name_[m.at("method")] = &m;
    const auto found = by_name_.find(c.at("baseline"));
    baseline_ = found == by_name_.end() ? nullptr : found->second;
    is_decidable_ = !is_said("cannot decide") && !is_said("a test needs");
    if (is_said("inf") || is_said("nan")) say("no number");
    if (baseline_ == nullptr) return;
    for (const auto& [name, m] : by_name_) check_method(name, *m);
    check_places();
    check_groups();
    check_numbers_of_sentence();
    check_failures_of_sentence();
    check_cautions();
    check_few();
  }

  const std::vector<std::string>& found() const { return found_; }

 private:
  using Json = nlohmann::json;

  bool is_said(const std::string& part) const { return text_.find(part) != std::string::npos; }
  void say(const std::string& what) { found_.push_back(what + ": " + text_); }

  const Json* find(const std::string& name) const {
    const auto found = by_name_.find(name);
    return found == by_name_.end() ? nullptr : found->second;
  }

  static bool is_first(const Json& m) { return m.at("place") == "="; }

  /// One that fails on a run, or covers less, is not shown to be better.
  static bool is_clean(const Json& m) { return m.at("fails") == 0 && m.at("coverage") == 1.0; }

  static double percent_of(const Json& ratio) { return 100.0 * (double(ratio) - 1.0); }

  /// Whether this is the printed number: at least two digits, and none behind the point from 10 on.
  static bool is_printed(const std::string& text, double value) {
    const double size = std::abs(value);
    double rounding = 0.0501 * size;
    if (size >= 0.95) rounding = size >= 9.95 ? 0.5001 : 0.0501;
    return std::abs(std::stod(text) - value) <= rounding;
  }

  void check_method(const std::string& name, const Json& m) {
    if (&m == baseline_ || m.at("interval").is_null()) return;
    const double low = m.at("interval")[0], high = m.at("interval")[1], ratio = m.at("ratio");
    if (low > ratio * (1.0 + 1e-9) || high < ratio * (1.0 - 1e-9)) say(name + " is outside");
    const bool is_excluded = low > 1.0 || high < 1.0;
    if (!m.at("p").is_null() && is_excluded != (m.at("p") <= alpha_))
      say(name + ": p and interval differ");
    double sum = 0.0;
    const auto& by_sequence = m.at("by_sequence");
    for (const auto& [sequence, own] : by_sequence.items()) sum += std::log(double(own));
    const auto count = static_cast<double>(by_sequence.size());
    if (count > 0.0 && std::abs(std::log(ratio) - sum / count) > 1e-6)
      say(name + " is not the mean of its sequences");
    if (!is_decidable_) return;
    if (is_first(m) && low > 1.0 + relevant_ && is_clean(*baseline_))
      say(name + " is = but shown to be worse than the baseline");
    if (is_first(*baseline_) && high < 1.0 / (1.0 + relevant_) && is_clean(m))
      say("the baseline is = but shown to be worse than " + name);
  }

  void check_places() {
    const auto first =
        std::ranges::count_if(by_name_, [](const auto& each) { return is_first(*each.second); });
    if (first == 0) say("no first place");
    const bool is_none = is_said("no method is best") || is_said("nothing is decided") ||
                         is_said("no method beats") || !is_decidable_;
    const bool is_best_said = !is_none && (is_said(" is best") || is_said(" are best"));
    if (c_.at("is_best") != is_best_said) say("is_best and sentence differ");
    if (is_said("nothing is decided") && std::size_t(first) != by_name_.size())
      say("some method is worse");
    std::smatch found;
    static const std::regex kBest(R"(: (?:the baseline )?(\S+) is best(?:[,:]|$))");
    if (!is_none && std::regex_search(text_, found, kBest)) {
      const Json* const best = find(found[1]);
      if (best == nullptr || !is_first(*best) || first != 1) {
        say("best and places differ");
      } else if (best != baseline_) {
        const auto& interval = best->at("interval");
        if (!interval.is_null() && interval[1] >= 1.0) say("best, but not below the baseline");
      }
    }
    static const std::regex kBelow(R"(no method is best: (\S+) is [\d.e-]+ % below)");
    if (std::regex_search(text_, found, kBelow)) {
      const Json* const m = find(found[1]);
      // An interval can have an end beyond all numbers; p is that of the same test.
      const bool has_interval = m != nullptr && !m->at("interval").is_null();
      if (m == nullptr || m->at("p").is_null() || m->at("p") > alpha_ ||
          (has_interval && m->at("interval")[1] >= 1.0))
        say("below, but not shown");
    }
    check_order();
  }

  /// No worse method has a change that is better than that of each method of the first place.
  void check_order() {
    double least = 1e300;
    const auto ratio_of = [&](const Json& m) {
      if (&m == baseline_) return std::optional(1.0);
      return m.at("ratio").is_null() ? std::nullopt : std::optional(double(m.at("ratio")));
    };
    for (const auto& [name, m] : by_name_) {
      if (is_first(*m)) least = std::min(least, ratio_of(*m).value_or(0.0));
    }
    for (const auto& [name, m] : by_name_) {
      if (is_first(*m) || m->at("fails") != 0 || m->at("coverage") != 1.0) continue;
      if (ratio_of(*m).value_or(1e300) < least) say(name + " is > and has the best change");
    }
  }

  void check_groups() {
    std::map<std::string, std::size_t> times;
    for (const auto& group : c_.at("groups_of_methods")) {
      std::optional<double> low, high;
      for (const std::string name : group.at("methods")) {
        ++times[name];
        const Json& m = *by_name_.at(name);
        if (!group.at("place").is_null() && group.at("place") != m.at("place"))
          say(name + ": place of its group differs");
        const bool is_left_out = &m == baseline_ && group.at("methods").size() > 1;
        if (is_left_out || m.at("ratio").is_null()) continue;
        const double change = percent_of(m.at("ratio"));
        low = std::min(low.value_or(change), change);
        high = std::max(high.value_or(change), change);
      }
      const auto& change = group.at("change");
      const bool is_same =
          change.is_null() == !low && (!low || (std::abs(double(change[0]) - *low) < 1e-6 &&
                                                std::abs(double(change[1]) - *high) < 1e-6));
      if (!is_same) say(std::string(group.at("name")) + ": change differs");
    }
    if (c_.at("groups_of_methods").empty()) return;
    for (const auto& [name, m] : by_name_) {
      const bool may_miss = m == baseline_;
      if (times[name] > 1 || (times[name] == 0 && !may_miss)) say(name + " is in no group, or two");
    }
  }

  /// "a is 37 % below m0 (95 %: 30 to 44)": the numbers of a.
  void check_numbers_of_sentence() {
    std::smatch found;
    static const std::regex kNumber(
        R"((\S+) is (?:best, )?([\d.e-]+) % (below|above) \S+ \(95 %: (-?[\d.e+-]+) to (-?[\d.e+-]+)\))");
    if (!std::regex_search(text_, found, kNumber)) return;
    const Json* const m = find(found[1]);
    if (m == nullptr || m->at("interval").is_null()) return say("numbers of nobody");
    const double sign = found[3] == "below" ? -1.0 : 1.0;
    const auto& interval = m->at("interval");
    const double near = sign * percent_of(interval[sign < 0.0 ? 1 : 0]);
    const double far = sign * percent_of(interval[sign < 0.0 ? 0 : 1]);
    if (!is_printed(found[2], sign * percent_of(m->at("ratio"))) || !is_printed(found[4], near) ||
        !is_printed(found[5], far))
      say("numbers differ");
    const bool is_printed_clear = std::stod(found[4]) > 0.0 && std::stod(found[5]) > 0.0;
    const bool is_claimed =
        is_said(std::string(found[1]) + " is best") || is_said("no method is best");
    if (is_claimed && !is_printed_clear) say("the printed interval holds 0");
    if (is_said("nothing is decided") && is_printed_clear && is_clean(*m) && is_clean(*baseline_) &&
        near > 100.0 * relevant_)
      say("nothing is decided, but the printed interval excludes 0");
  }

  void check_failures_of_sentence() {
    static const std::regex kFails(R"((\S+) fails on (\d+))");
    for (std::sregex_iterator it(text_.begin(), text_.end(), kFails), end; it != end; ++it) {
      const Json* const m = find((*it)[1]);
      if (m == nullptr || m->at("fails") != std::stoi((*it)[2])) say("other failures");
    }
    std::smatch found;
    static const std::regex kBest(R"(: (\S+) is best, )");
    if (std::regex_search(text_, found, kBest) && find(found[1]) != nullptr &&
        find(found[1])->at("fails") > 0 && !is_said(std::string(found[1]) + " fails on"))
      say("best, but its failures are not stated");
  }

  /// "a is 60 % worse than m0 on s": so are its numbers, and significant where that is not denied.
  void check_cautions() {
    static const std::regex kCaution(
        R"(^(\S+) is ([\d.e+]+) % worse than \S+ on (.*?)(?:,|;| \(|$))");
    for (const std::string caution : c_.at("cautions")) {
      std::smatch found;
      if (!std::regex_search(caution, found, kCaution)) continue;
      const Json* const m = find(found[1]);
      const std::string sequence = found[3];
      if (m == nullptr || !m->at("by_sequence").contains(sequence)) {
        say("caution of nobody, " + caution);
        continue;
      }
      const double change = percent_of(m->at("by_sequence").at(sequence));
      if (change <= 0.0 || !is_printed(found[2], change)) say("caution differs, " + caution);
      const auto& shown = m->at("significant_on");
      const bool is_shown = std::ranges::count(shown, Json(sequence)) > 0;
      if (is_shown == caution.ends_with("(not significant)")) say("caution and test, " + caution);
    }
  }

  void check_few() {
    std::smatch found;
    static const std::regex kFew(
        R"((\d+) (?:run|sequence|group).* cannot decide .* methods: (\d+) would)");
    if (std::regex_search(text_, found, kFew) && !is_said("two methods solved") &&
        std::stoi(found[1]) >= std::stoi(found[2]))
      say("so many would do");
    if (is_decidable_) return;
    for (const auto& [name, m] : by_name_) {
      if (!m->at("p").is_null() && m->at("p") <= alpha_) say(name + " is shown, by too few runs");
    }
  }

  const Json& c_;
  std::string text_;
  double relevant_;
  double alpha_;
  std::map<std::string, const Json*> by_name_;
  const Json* baseline_ = nullptr;
  bool is_decidable_ = true;
  std::vector<std::string> found_;
};

/// What the statements contradict; empty for none.
inline std::vector<std::string> contradictions(const nlohmann::json& comparison) {
  return Contradictions(comparison).found();
}

}  // namespace loopbench
