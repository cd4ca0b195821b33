#include "datasets/bags/bag_name.hpp"

#include <string_view>

namespace loopbench {
namespace {

constexpr std::string_view kBagPrefix = "bag:";

}  // namespace

bool names_bag(const std::string& name) { return name.starts_with(kBagPrefix); }

BagName bag_name(const std::string& name) {
  const std::string rest = names_bag(name) ? name.substr(kBagPrefix.size()) : name;
  const std::size_t hash = rest.rfind('#');
  if (hash == rest.npos) return {rest};
  std::string topic = rest.substr(hash + 1);
  if (topic.starts_with("/tf:")) topic.erase(0, 1);  // as evo writes it
  return {rest.substr(0, hash), topic};
}

std::string to_text(const BagName& name) {
  return std::string(kBagPrefix) + name.file + (name.topic.empty() ? "" : "#" + name.topic);
}

std::string file_of(const std::string& name) {
  return names_bag(name) ? bag_name(name).file : name;
}

}  // namespace loopbench
