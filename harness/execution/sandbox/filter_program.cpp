#include "harness/execution/sandbox/filter_program.hpp"

#include <linux/seccomp.h>

#include <algorithm>
#include <cstddef>
#include <span>

namespace loopbench::harness {
namespace {

constexpr std::size_t kLeaf = 2;  ///< rules that are compared one after the other

sock_filter instruction(int code, std::uint32_t value, int if_true = 0, int if_false = 0) {
  return {static_cast<std::uint16_t>(code),
          static_cast<std::uint8_t>(if_true),
          static_cast<std::uint8_t>(if_false),
          value};
}

/// `rules` in ascending order of numbers.
void add_tree(std::span<const CallRule> rules, std::vector<sock_filter>& out) {
  if (rules.size() <= kLeaf) {
    for (const CallRule& rule : rules) {
      const int size = static_cast<int>(rule.code.size());
      out.push_back(instruction(BPF_JMP | BPF_JEQ | BPF_K, rule.number, 0, size));
      out.insert(out.end(), rule.code.begin(), rule.code.end());
    }
    return out.push_back(instruction(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
  }
  const std::size_t middle = rules.size() / 2;
  out.push_back(instruction(BPF_JMP | BPF_JGE | BPF_K, rules[middle].number, 0, 1));
  const std::size_t jump = out.size();
  out.push_back(instruction(BPF_JMP | BPF_JA, 0));  // its distance does not fit into the condition
  add_tree(rules.first(middle), out);
  out[jump].k = static_cast<std::uint32_t>(out.size() - jump - 1);
  add_tree(rules.subspan(middle), out);
}

}  // namespace

std::vector<sock_filter> filter_program(const CallTable& table,
                                        std::uint32_t refused,
                                        std::vector<CallRule> rules) {
  std::ranges::sort(rules, {}, &CallRule::number);
  std::vector<sock_filter> out{
      instruction(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, arch)),
      instruction(BPF_JMP | BPF_JEQ | BPF_K, table.architecture, 1, 0),
      instruction(BPF_RET | BPF_K, refused),
      instruction(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      instruction(BPF_JMP | BPF_JSET | BPF_K, table.excluded, 0, 1),
      instruction(BPF_RET | BPF_K, refused),
  };
  add_tree(rules, out);
  return out;
}

}  // namespace loopbench::harness
