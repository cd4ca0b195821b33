#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>

#include "datasets/core/error.hpp"
#include "harness/config/yaml.hpp"
#include "harness/get/download.hpp"

namespace loopbench::harness {
namespace {

// Their publishers state no SHA-256, so all entries are pinned by the first download.
const char* const kPublicFiles = R"(
- name: tum_fr1_room
  url: https://cvg.cit.tum.de/rgbd/dataset/freiburg1/rgbd_dataset_freiburg1_room.tgz
  licence: CC BY 4.0
  file: tum_rgbd/rgbd_dataset_freiburg1_room.tgz
  summary: TUM RGB-D fr1_room, images and ground truth (the article's first sequence)
- name: tum_fr3_office
  url: https://cvg.cit.tum.de/rgbd/dataset/freiburg3/rgbd_dataset_freiburg3_long_office_household.tgz
  licence: CC BY 4.0
  file: tum_rgbd/rgbd_dataset_freiburg3_long_office_household.tgz
  summary: TUM RGB-D fr3_office, images and ground truth (the article's second sequence)
- name: kitti_poses
  url: https://s3.eu-central-1.amazonaws.com/avg-kitti/data_odometry_poses.zip
  licence: CC BY-NC-SA 3.0
  file: kitti/data_odometry_poses.zip
  summary: KITTI odometry, ground-truth poses of sequences 00 to 10
- name: seven_scenes_chess
  url: http://download.microsoft.com/download/2/8/5/28564B23-0828-408F-8631-23B1EFF1DAC8/chess.zip
  licence: Microsoft Research, non-commercial use only
  file: seven_scenes/chess.zip
  summary: 7-Scenes chess, RGB-D images and poses
- name: euroc_mh_01
  url: http://robotics.ethz.ch/~asl-datasets/ijrr_euroc_mav_dataset/machine_hall/MH_01_easy/MH_01_easy.zip
  licence: ETH Zurich ASL, see the dataset's page
  file: euroc/MH_01_easy.zip
  summary: EuRoC MH_01_easy, images, IMU and ground truth
- name: parking_garage
  url: https://raw.githubusercontent.com/borglab/gtsam/4.2/examples/Data/parking-garage.g2o
  licence: BSD-3-Clause (GTSAM)
  file: pose_graphs/parking-garage.g2o
  summary: pose graph of a parking garage, 1661 keyframes
)";

const std::vector<std::string> kFields{"name", "url", "licence", "sha256", "file", "summary"};

bool is_sha256(const std::string& text) {
  return text.size() == 64 && std::ranges::all_of(text, [](char c) {
           return std::isdigit(static_cast<unsigned char>(c)) || (c >= 'a' && c <= 'f');
         });
}

PublicFile public_file(const YamlNode& entry, const std::string& catalogue) {
  const auto text = [&](const std::string& key, bool is_required) {
    const YamlNode* node = entry.find(key);
    const bool is_text = node != nullptr && node->type == YamlNode::Type::scalar;
    if (is_required && !is_text) {
      throw input_error(
          catalogue, entry.line, "expected an entry with name, url, licence and file");
    }
    return is_text ? node->text : std::string();
  };
  PublicFile out{text("name", true),
                 text("url", true),
                 text("licence", true),
                 text("sha256", false),
                 text("file", true),
                 text("summary", false)};
  for (const YamlEntry& each : entry.map) {
    if (std::ranges::count(kFields, each.key) == 0) {
      throw input_error(catalogue, each.value.line, "no field is named '" + each.key + "'");
    }
  }
  if (!out.sha256.empty() && !is_sha256(out.sha256)) {
    throw input_error(catalogue,
                      entry.line,
                      "sha256: expected 64 lower-case hexadecimal digits, found " + out.sha256);
  }
  const bool is_below = out.file.is_relative() && !out.file.empty() &&
                        std::ranges::count(out.file, std::filesystem::path("..")) == 0;
  if (!is_below) {
    throw input_error(catalogue,
                      entry.line,
                      "file: expected a path below the data folder, found " + out.file.string());
  }
  return out;
}

std::vector<PublicFile> parse_public_files(const std::string& text, const std::string& catalogue) {
  const YamlNode root = parse_yaml(text, catalogue);
  if (root.type != YamlNode::Type::list) {
    throw input_error(
        catalogue, root.line, "expected a list of {name, url, licence, sha256, file}");
  }
  std::vector<PublicFile> out;
  for (const YamlNode& entry : root.list) out.push_back(public_file(entry, catalogue));
  return out;
}

}  // namespace

std::vector<PublicFile> public_files() { return parse_public_files(kPublicFiles, "catalogue"); }

std::vector<PublicFile> read_public_files(const std::filesystem::path& catalogue) {
  std::ifstream in(catalogue, std::ios::binary);
  if (!in || std::filesystem::is_directory(catalogue)) {
    throw InputError(catalogue.string() + ": cannot be read, expected a YAML catalogue");
  }
  return parse_public_files({std::istreambuf_iterator<char>(in), {}}, catalogue.string());
}

}  // namespace loopbench::harness
