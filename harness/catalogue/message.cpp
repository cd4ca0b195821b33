#include "harness/catalogue/message.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "datasets/core/fields.hpp"
#include "harness/catalogue/unit_rotation.hpp"

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

void add_poses(Values& out, const Trajectory& poses) {
  for (const StampedPose& pose : poses) {
    out.push_back(pose.stamp);
    add_pose(out, pose.world_from_body);
  }
}

void add_edges(Values& out, const std::vector<Edge>& edges) {
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

/// What a request about a problem contains.
struct Arrays {
  const Trajectory* keyframes;
  const Trajectory* frames;
  std::vector<std::pair<const char*, const std::vector<Edge>*>> edges;
};

/// `keys`: members of the JSON object in addition to those that follow from the arrays.
std::string message_of(const Arrays& arrays, const std::string& keys, std::uint64_t number) {
  const auto changes_scale = [](const Edge& edge) { return edge.scale != 1.0; };
  bool similarity = false;
  std::string shapes = fmt::format(R"(["keyframes",{},{}],["frames",{},{}])",
                                   arrays.keyframes->size(),
                                   kPoseColumns,
                                   arrays.frames->size(),
                                   kPoseColumns);
  std::size_t size = kPoseColumns * (arrays.keyframes->size() + arrays.frames->size());
  for (const auto& [name, edges] : arrays.edges) {
    similarity = similarity || std::ranges::any_of(*edges, changes_scale);
    shapes += fmt::format(R"(,["{}",{},{}])", name, edges->size(), kEdgeColumns);
    size += kEdgeColumns * edges->size();
  }
  Values values;
  values.reserve(size);
  add_poses(values, *arrays.keyframes);
  add_poses(values, *arrays.frames);
  for (const auto& [name, edges] : arrays.edges) add_edges(values, *edges);
  return message(fmt::format(R"({{"exchange":{},"similarity":{},{},"arrays":[{}]}})",
                             kExchangeVersion,
                             similarity,
                             keys,
                             shapes),
                 values,
                 number);
}

}  // namespace

std::string request(nlohmann::json text,
                    const std::vector<std::pair<std::string, const Trajectory*>>& arrays,
                    std::uint64_t number) {
  Values values;
  for (const auto& [name, poses] : arrays) {
    text["arrays"].push_back({name, poses->size(), kPoseColumns});
    add_poses(values, *poses);
  }
  return message(text.dump(), values, number);
}

std::string request(const Problem& problem, ResultPoses output, std::uint64_t number) {
  return message_of(Arrays{&problem.keyframes,
                           &problem.frames,
                           {{"odometry", &problem.odometry}, {"closures", &problem.closures}}},
                    fmt::format(R"("planar":{},"output":"{}")", problem.planar, to_text(output)),
                    number);
}

std::string request(const methods::Increment& added,
                    std::size_t update,
                    bool planar,
                    std::uint64_t number) {
  return message_of(
      Arrays{&added.keyframes,
             &added.frames,
             {{"odometry", &added.odometry},
              {"closures", &added.closures},
              {"withdrawn", &added.withdrawn}}},
      fmt::format(
          R"("kind":"update","update":{},"planar":{},"output":"keyframes")", update, planar),
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
