#include "datasets/bags/bag_trajectory.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <string_view>

#include "datasets/bags/byte_reader.hpp"
#include "datasets/bags/transform_tree.hpp"

namespace loopbench {
namespace {

constexpr std::string_view kTf = "tf:";

bool has_poses(const BagTopic& topic) {
  return topic.type != MessageType::other && topic.type != MessageType::tf;
}

/// Normalises the quaternion; false for a pose that is not one.
bool normalise_pose(Pose& pose, double& off_unit) {
  return is_finite(pose) && normalise(pose.rotation, off_unit);
}

std::string known_topics(const std::vector<BagTopic>& topics) {
  std::string out;
  bool has_tf = false;
  for (const BagTopic& topic : topics) {
    has_tf |= topic.type == MessageType::tf;
    if (has_poses(topic)) out += (out.empty() ? "" : ", ") + topic.name;
  }
  if (has_tf) out += out.empty() ? "only TF: tf:PARENT.CHILD" : ", tf:PARENT.CHILD";
  return out.empty() ? "none" : out;
}

/// Messages of the wanted topics, with the number of those that cannot be decoded.
struct Decoded {
  std::vector<PoseMessage> poses;
  std::size_t damaged = 0;
  BagSummary summary;
};

template <class Use>
Decoded decode_all(const std::string& file, const WantsTopic& wants, Use use) {
  Decoded out;
  out.summary = read_bag(file, wants, [&](const BagTopic& topic, std::string_view message) {
    try {
      use(topic, decode(topic, message), out.poses);
    } catch (const DamagedRecord&) {
      ++out.damaged;
    }
  });
  return out;
}

/// For errors: the reason why something can be missing.
std::string damage_text(const BagSummary& summary) {
  return summary.damage.empty() ? "" : "; the bag is damaged: " + summary.damage;
}

/// "; frames: base_link, map", or empty without TF.
std::string tf_frames(const std::string& file) {
  std::set<std::string> frames;
  decode_all(
      file,
      [](const BagTopic& topic) { return topic.type == MessageType::tf; },
      [&](const BagTopic&, const std::vector<PoseMessage>& transforms, const auto&) {
        for (const PoseMessage& each : transforms) frames.insert({each.frame, each.child});
      });
  return frames.empty() ? "" : fmt::format("; frames: {}", fmt::join(frames, ", "));
}

std::string only_topic(const std::string& file) {
  const BagSummary summary = bag_topics(file);
  std::vector<BagTopic> topics = summary.topics;
  const std::string known = known_topics(topics);
  std::erase_if(topics, [](const BagTopic& topic) { return !has_poses(topic); });
  const auto has_rotations = [](const BagTopic& topic) { return !has_only_positions(topic.type); };
  if (std::ranges::any_of(topics, has_rotations)) std::erase_if(topics, std::not_fn(has_rotations));
  if (topics.size() == 1) return topics[0].name;
  throw InputError(file + ": has " + std::to_string(topics.size()) +
                   " topics with poses, expected bag:" + file + "#TOPIC (topics: " + known +
                   tf_frames(file) + ")" + damage_text(summary));
}

Decoded read_topic(const std::string& file, const std::string& name) {
  const auto append =
      [](const BagTopic& topic, std::vector<PoseMessage> poses, std::vector<PoseMessage>& all) {
        if (topic.type == MessageType::path && !poses.empty()) all.clear();  // paths grow
        for (PoseMessage& pose : poses) all.push_back(std::move(pose));
      };
  Decoded out = decode_all(
      file, [&](const BagTopic& topic) { return topic.name == name && has_poses(topic); }, append);
  const auto found = std::ranges::find(out.summary.topics, name, &BagTopic::name);
  const auto known = [&] {
    return " (topics: " + known_topics(out.summary.topics) + tf_frames(file) + ")";
  };
  if (found == out.summary.topics.end()) {
    throw InputError(file + ": has no topic '" + name + "'" + known() + damage_text(out.summary));
  }
  if (!has_poses(*found)) {
    throw InputError(file + ": topic '" + name + "' has type " + found->type_name +
                     ", expected PoseStamped, PoseWithCovarianceStamped, Odometry, "
                     "TransformStamped, Path, PointStamped or NavSatFix" +
                     known());
  }
  for (const PoseMessage& pose : out.poses) {
    if (pose.child == out.poses.front().child) continue;
    throw InputError(file + ": topic '" + name + "' has poses of '" + out.poses.front().child +
                     "' and '" + pose.child + "', expected one child frame");
  }
  return out;
}

Decoded read_tf(const std::string& file, const std::string& frames) {
  TransformTree tree(file);
  std::string damage;
  std::size_t invalid = 0;
  double off_unit = 0.0;
  const auto add = [&](const BagTopic& topic,
                       const std::vector<PoseMessage>& transforms,
                       std::vector<PoseMessage>&) {
    for (PoseMessage transform : transforms) {
      if (normalise_pose(transform.frame_from_child, off_unit)) {
        tree.add(transform, topic.name.ends_with("static"));
      } else {
        ++invalid;
      }
    }
  };
  try {
    Decoded out = decode_all(
        file, [](const BagTopic& topic) { return topic.type == MessageType::tf; }, add);
    out.damaged += invalid;
    damage = damage_text(out.summary);
    tree.finish();
    // A frame's name can contain dots.
    const std::vector<std::string> known = tree.frames();
    for (std::size_t dot = frames.find('.'); dot != frames.npos; dot = frames.find('.', dot + 1)) {
      const std::string parent = frames.substr(0, dot);
      const std::string child = frames.substr(dot + 1);
      const bool is_last = frames.find('.', dot + 1) == frames.npos;
      if (!is_last &&
          !(std::ranges::count(known, parent) > 0 && std::ranges::count(known, child) > 0)) {
        continue;
      }
      out.poses = tree.trajectory(parent, child);
      return out;
    }
  } catch (const InputError& error) {
    throw InputError(error.what() + damage);
  }
  throw InputError(file + ": tf:" + frames + ": expected tf:PARENT.CHILD");
}

constexpr std::string_view kBagPrefix = "bag:";

}  // namespace

BagTrajectory read_bag_trajectory(const BagName& name) {
  BagTrajectory out;
  out.topic = name.topic.empty() ? only_topic(name.file) : name.topic;
  Decoded read = out.topic.starts_with(kTf) ? read_tf(name.file, out.topic.substr(kTf.size()))
                                            : read_topic(name.file, out.topic);
  const auto topic = std::ranges::find(read.summary.topics, out.topic, &BagTopic::name);
  const MessageType type = topic == read.summary.topics.end() ? MessageType::tf : topic->type;
  out.is_geodetic = type == MessageType::nav_sat_fix;
  const auto invalid = std::erase_if(read.poses, [&](PoseMessage& pose) {
    if (has_only_positions(type)) return !pose.frame_from_child.translation.allFinite();
    return !normalise_pose(pose.frame_from_child, out.off_unit);
  });
  out.poses = std::move(read.poses);
  std::ranges::stable_sort(out.poses, {}, &PoseMessage::nanoseconds);
  const std::size_t skipped = read.damaged + invalid;
  if (skipped > 0) {
    read.summary.add_damage(fmt::format("{} messages without a valid pose were skipped", skipped));
  }
  out.damage = read.summary.damage;
  if (!out.poses.empty()) return out;
  throw InputError(name.file + ": has no poses in '" + out.topic + "'" +
                   (out.damage.empty() ? "" : " (" + out.damage + ")"));
}

BagSummary bag_topics(const std::string& file) {
  BagSummary out = read_bag(
      file, [](const BagTopic&) { return false; }, [](const BagTopic&, std::string_view) {});
  std::erase_if(out.topics, [](const BagTopic& topic) { return topic.type == MessageType::other; });
  return out;
}

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
