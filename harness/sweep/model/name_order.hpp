#pragma once

#include <cstddef>
#include <string>
#include <unordered_map>
#include <vector>

namespace loopbench::harness {

/// Numbers names in the order they first appear. O(size) each.
class NameOrder {
 public:
  std::size_t index(const std::string& name) {
    const auto [found, is_new] = index_.emplace(name, names_.size());
    if (is_new) names_.push_back(name);
    return found->second;
  }
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::unordered_map<std::string, std::size_t> index_;
  std::vector<std::string> names_;
};

}  // namespace loopbench::harness
