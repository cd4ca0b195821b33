#include "harness/sweep/catalogue/message.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "datasets/core/fields.hpp"
#include "datasets/core/pose_rule.hpp"

namespace loopbench::harness {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::size_t kPoseColumns = 8;
constexpr std::size_t kEdgeColumns = 46;
constexpr std::uint64_t kMostText = std::uint64_t{16} << 20;   // [bytes]
constexpr std::uint64_t kMostData = std::uint64_t{256} << 20;  // [bytes]
constexpr std::uint64_t kMostPosesPerKeyframe = 1000;

using Values = std::vector<double>;

void add_pose(Values& out, const Pose& pose) {
  for (const double x : pose.translation) out.push_back(x);
  for (const double x : pose.rotation.coeffs()) out.push_back(x);
}

void append_rows(Values& out, const Trajectory& poses) {
  for (const StampedPose& pose : poses) {
    out.push_back(pose.stamp);
    add_pose(out, pose.world_from_body);
  }
}

void append_rows(Values& out, const std::vector<Edge>& edges) {
  for (const Edge& edge : edges) {
    out.push_back(static_cast<double>(edge.from));
    out.push_back(static_cast<double>(edge.to));
    add_pose(out, edge.from_from_to);
    out.push_back(edge.scale);
    out.insert(out.end(), edge.information.data(), edge.information.data() + 36);  // symmetric
  }
}

std::string message(const std::string& text, const Values& values, std::uint64_t number) {
  MessageHeader header;
  header.number = number;
  header.text = text.size();
  header.data = values.size() * sizeof(double);
  std::string out;
  out.reserve(sizeof header + header.text + header.data);
  out.append(reinterpret_cast<const char*>(&header), sizeof header);
  out += text;
  out.append(reinterpret_cast<const char*>(values.data()), header.data);
  return out;
}

}  // namespace

std::string request(nlohmann::json text,
                    const std::vector<std::pair<std::string, const Trajectory*>>& poses,
                    const std::vector<std::pair<std::string, const std::vector<Edge>*>>& edges,
                    std::uint64_t number) {
  std::size_t size = 0;
  for (const auto& [name, each] : poses) size += kPoseColumns * each->size();
  for (const auto& [name, each] : edges) size += kEdgeColumns * each->size();
  Values values;
  values.reserve(size);
  for (const auto& [name, each] : poses) {
    text["arrays"].push_back({name, each->size(), kPoseColumns});
    append_rows(values, *each);
  }
  bool similarity = false;
  for (const auto& [name, each] : edges) {
    text["arrays"].push_back({name, each->size(), kEdgeColumns});
    append_rows(values, *each);
    similarity = similarity ||
                 std::ranges::any_of(*each, [](const Edge& edge) { return edge.scale != 1.0; });
  }
  text["exchange"] = kExchangeVersion;
  if (!edges.empty()) text["similarity"] = similarity;
  return message(text.dump(), values, number);
}

std::string request(const Problem& problem, ResultPoses output, std::uint64_t number) {
  return request({{"planar", problem.planar}, {"output", to_text(output)}},
                 {{"keyframes", &problem.keyframes}, {"frames", &problem.frames}},
                 {{"odometry", &problem.odometry}, {"closures", &problem.closures}},
                 number);
}

std::string request(const methods::Increment& added,
                    std::size_t update,
                    bool planar,
                    std::uint64_t number) {
  return request(
      {{"kind", "update"}, {"update", update}, {"planar", planar}, {"output", "keyframes"}},
      {{"keyframes", &added.keyframes}, {"frames", &added.frames}},
      {{"odometry", &added.odometry},
       {"closures", &added.closures},
       {"withdrawn", &added.withdrawn}},
      number);
}

void check_header(const MessageHeader& header, std::uint64_t number, std::size_t keyframes) {
  if (std::memcmp(header.magic, MessageHeader{}.magic, sizeof header.magic) != 0) {
    throw std::runtime_error("the program wrote something else than an answer");
  }
  if (header.number != number) {
    throw std::runtime_error(
        fmt::format("the program answered request {}, expected {}", header.number, number));
  }
  const std::uint64_t most =
      kMostData + kMostPosesPerKeyframe * kPoseColumns * sizeof(double) * keyframes;
  if (header.text > kMostText || header.data > most) {
    throw std::runtime_error(fmt::format("the answer has {} + {} bytes, expected at most {} + {}",
                                         header.text,
                                         header.data,
                                         kMostText,
                                         most));
  }
}

Trajectory answer_poses(const std::string& text,
                        const std::string& data,
                        ResultMetadata& metadata) {
  metadata = parse_metadata(text);
  require_ok(metadata);
  std::size_t rows = 0;
  try {
    rows = nlohmann::json::parse(text).at("poses").get<std::size_t>();
  } catch (const nlohmann::json::exception& error) {
    throw std::runtime_error(std::string("the answer has no number of poses: ") + error.what());
  }
  if (data.size() != rows * kPoseColumns * sizeof(double)) {
    throw std::runtime_error(
        fmt::format("the answer has {} bytes of data for {} poses", data.size(), rows));
  }
  Trajectory out(rows);
  double off_unit = 0.0;
  for (std::size_t i = 0; i < rows; ++i) {
    double row[kPoseColumns];
    std::memcpy(row, data.data() + i * sizeof row, sizeof row);
    out[i].stamp = row[0];
    out[i].world_from_body.translation = {row[1], row[2], row[3]};
    out[i].world_from_body.rotation = unit_rotation(Rotation(row[7], row[4], row[5], row[6]),
                                                    "the answer: pose " + std::to_string(i),
                                                    off_unit);
  }
  return out;
}

}  // namespace loopbench::harness
