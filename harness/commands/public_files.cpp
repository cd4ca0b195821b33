#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>

#include "datasets/core/error.hpp"
#include "harness/commands/download.hpp"
#include "harness/config/yaml.hpp"

namespace loopbench::harness {
namespace {

// Hashes of g2o and KITTI files are those of the copies that the project is tested with. TUM states
// none, ETH only an MD5: those of the archives are what several projects recorded for them.
const char* const kPublicFiles = R"(
- name: tum_fr1_room
  url: https://cvg.cit.tum.de/rgbd/dataset/freiburg1/rgbd_dataset_freiburg1_room.tgz
  licence: CC BY 4.0
  sha256: 5ace47a1d2e53696bc939a84999293a04a7226958e848a609666691fd3cc38da
  file: tum_rgbd/rgbd_dataset_freiburg1_room.tgz
  summary: TUM RGB-D fr1_room, images and truth, 0.8 GB (the article's first sequence)
- name: tum_fr3_office
  url: https://cvg.cit.tum.de/rgbd/dataset/freiburg3/rgbd_dataset_freiburg3_long_office_household.tgz
  licence: CC BY 4.0
  sha256: c7cd8e1afb87c80e5744a356214819b110fa09b4744fa4ba0cc2382f9ba59e9c
  file: tum_rgbd/rgbd_dataset_freiburg3_long_office_household.tgz
  summary: TUM RGB-D fr3_office, images and truth, 1.5 GB (the article's second sequence)
- name: tum_fr1_desk
  url: https://cvg.cit.tum.de/rgbd/dataset/freiburg1/rgbd_dataset_freiburg1_desk.tgz
  licence: CC BY 4.0
  sha256: e983d6830916e66dc4a46a71368046b149b283de87769690e7aa4e0b9483530c
  file: tum_rgbd/rgbd_dataset_freiburg1_desk.tgz
  summary: TUM RGB-D fr1_desk, images and truth, 0.3 GB
- name: tum_fr1_xyz
  url: https://cvg.cit.tum.de/rgbd/dataset/freiburg1/rgbd_dataset_freiburg1_xyz.tgz
  licence: CC BY 4.0
  sha256: a0236d97b8c30cd93b653656d2b6c293ff7c982a4130ef2a1a8beecdb124ef98
  file: tum_rgbd/rgbd_dataset_freiburg1_xyz.tgz
  summary: TUM RGB-D fr1_xyz, images and truth, 0.4 GB
- name: kitti_00
  url: https://raw.githubusercontent.com/MichaelGrupp/evo/9ec1444a9f26a24261e1c126cd4ee2d7877cc395/test/data/KITTI_00_gt.txt
  licence: CC BY-NC-SA 3.0
  sha256: 90791a4113df979b149fa9e1104e960ea59f525a8318a202dbb6aec1a3d88793
  file: kitti/00/gt_poses.txt
  summary: KITTI odometry 00, ground-truth poses, 0.7 MB
- name: euroc_machine_hall
  url: https://www.research-collection.ethz.ch/server/api/core/bitstreams/7b2419c1-62b5-4714-b7f8-485e5fe3e5fe/content
  licence: in copyright, non-commercial use permitted
  sha256: 5ed7d07903f8d19b6c8808e2ae8a0872b281f6e34ef5497023b8ac58c3de0f6f
  file: euroc/machine_hall.zip
  summary: EuRoC MH_01 to MH_05, images, IMU and truth, 12.7 GB
- name: parking_garage
  url: https://raw.githubusercontent.com/david-m-rosen/SE-Sync/master/data/parking-garage.g2o
  licence: LGPL-3.0 (SE-Sync)
  sha256: 3ac0a31bfb601d7455d451e2546655cb5dececf51a7823f57c8a7e0fe1ca6527
  file: pose_graphs/parking-garage.g2o
  summary: pose graph of a parking garage (3-D, real), 1.3 MB
- name: intel
  url: https://raw.githubusercontent.com/david-m-rosen/SE-Sync/master/data/intel.g2o
  licence: LGPL-3.0 (SE-Sync)
  sha256: 3e0724c048e0ba524be9dd268a8b78e19a2497043143584cbb61310638b15c4b
  file: pose_graphs/intel.g2o
  summary: pose graph of the Intel research lab (planar, real), 0.3 MB
- name: mit
  url: https://raw.githubusercontent.com/david-m-rosen/SE-Sync/master/data/MIT.g2o
  licence: LGPL-3.0 (SE-Sync)
  sha256: e5922be0d0689c7a5bc04c58adf3a8e697e240bdd7691cc4218470eaf92956eb
  file: pose_graphs/MIT.g2o
  summary: pose graph of MIT Killian Court (planar, real), 0.1 MB
- name: cubicle
  url: https://raw.githubusercontent.com/david-m-rosen/SE-Sync/master/data/cubicle.g2o
  licence: LGPL-3.0 (SE-Sync)
  sha256: f7781d485383cec86d47d7650970132c36d6f3a1f4e5d62a49b7f8245c0a6465
  file: pose_graphs/cubicle.g2o
  summary: pose graph of an office (3-D, real), 2.7 MB
- name: city10000
  url: https://raw.githubusercontent.com/david-m-rosen/SE-Sync/master/data/city10000.g2o
  licence: LGPL-3.0 (SE-Sync)
  sha256: df5988994339e990be198a36e7f640e31a5a1b26df3ed400363fafc49d5ca630
  file: pose_graphs/city10000.g2o
  summary: pose graph of a city (planar, simulated), 1.8 MB
- name: sphere2500
  url: https://raw.githubusercontent.com/david-m-rosen/SE-Sync/master/data/sphere2500.g2o
  licence: LGPL-3.0 (SE-Sync)
  sha256: 104ab57593394f24351d9f692f3b923f8b98fff1eb638c64356cf5049e06cf3c
  file: pose_graphs/sphere2500.g2o
  summary: pose graph on a sphere (3-D, simulated), 1.1 MB
- name: torus3d
  url: https://raw.githubusercontent.com/david-m-rosen/SE-Sync/master/data/torus3D.g2o
  licence: LGPL-3.0 (SE-Sync)
  sha256: 1ef8831023b372188d33ca63ce0da079d51df89364df71f2bce1c5c7c69ed5ec
  file: pose_graphs/torus3D.g2o
  summary: pose graph on a torus (3-D, simulated), 3.3 MB
- name: small_grid_3d
  url: https://raw.githubusercontent.com/david-m-rosen/SE-Sync/master/data/smallGrid3D.g2o
  licence: LGPL-3.0 (SE-Sync)
  sha256: 9ea56c2ad1ebcc322560eb2f8d83cb3a60f99e2e2acc35e097b1162cdbafd649
  file: pose_graphs/smallGrid3D.g2o
  summary: pose graph of a small grid (3-D, simulated), 0.1 MB
)";

const std::vector<std::string> kFields{"name", "url", "licence", "sha256", "file", "summary"};

bool is_sha256(const std::string& text) {
  return text.size() == 64 && std::ranges::all_of(text, [](char c) {
           return std::isdigit(static_cast<unsigned char>(c)) || (c >= 'a' && c <= 'f');
         });
}

PublicFile public_file(const YamlNode& entry, const std::string& catalogue) {
  const auto text = [&](const std::string& key, bool is_required = true) {
    const YamlNode* node = entry.find(key);
    const bool is_text = node != nullptr && node->type == YamlNode::Type::scalar;
    if (is_required && !is_text) {
      throw input_error(
          catalogue, entry.line, "expected an entry with name, url, licence, sha256 and file");
    }
    return is_text ? node->text : std::string();
  };
  PublicFile out{text("name"),
                 text("url"),
                 text("licence"),
                 text("sha256"),
                 text("file"),
                 text("summary", false)};
  for (const YamlEntry& each : entry.map) {
    if (std::ranges::count(kFields, each.key) == 0) {
      throw input_error(catalogue, each.value.line, "no field is named '" + each.key + "'");
    }
  }
  if (!is_sha256(out.sha256)) {
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
