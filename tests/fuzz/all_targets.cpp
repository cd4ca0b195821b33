#include "tests/fuzz/targets.hpp"

namespace loopbench {

const std::map<std::string, void (*)(const std::filesystem::path& file)>& fuzz_targets() {
  static const std::map<std::string, void (*)(const std::filesystem::path& file)> all{
      {"tum", fuzz_tum},
      {"kitti", fuzz_kitti},
      {"euroc", fuzz_euroc},
      {"any", fuzz_any},
      {"g2o", fuzz_g2o},
      {"times", fuzz_times},
      {"closures", fuzz_closures},
      {"bag", fuzz_bag},
      {"csv", fuzz_csv},
      {"matrices", fuzz_matrices},
      {"config", fuzz_config},
      {"store", fuzz_store},
      {"report", fuzz_report},
      {"gate", fuzz_gate},
      {"where", fuzz_where},
      {"eval", fuzz_eval},
      {"eval_files", fuzz_eval_files},
      {"messages", fuzz_messages},
      {"camera", fuzz_camera},
      {"image_list", fuzz_image_list},
      {"layout", fuzz_layout},
      {"image", fuzz_image}};
  return all;
}

}  // namespace loopbench
