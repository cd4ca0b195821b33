/// Settings of cluster jobs: `cluster:` of a config, a file of the user, options of `submit`.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

#include "datasets/core/fields.hpp"
#include "harness/config/yaml.hpp"

namespace loopbench::harness {

enum class Engine { slurm, local };
inline auto choices(Engine) {
  return std::array{std::pair{"slurm", Engine::slurm}, std::pair{"local", Engine::local}};
}

struct ClusterSettings {
  Engine engine = Engine::slurm;
  std::int64_t array = 8;
  std::int64_t cores = 1;
  std::string time;
  std::string memory;
  std::string partition;
  std::string account;
  std::string qos;
  std::string constraint;
  std::int64_t signal = 120;
  std::string stage;
};

template <class Visit>
void fields(ClusterSettings& o, Visit visit) {
  visit(
      "engine", o.engine, "what runs the shards: a Slurm array job, or processes of this machine");
  visit("array", o.array, "number of shards", Between{1.0, 1e6});
  visit("cores", o.cores, "cores of one shard", Between{1.0, 1024.0});
  visit("time", o.time, "time limit of a shard as in Slurm: MINUTES, HH:MM:SS or D-HH:MM:SS");
  visit("memory", o.memory, "memory of one shard, for example 4GiB");
  visit("partition", o.partition, "Slurm partition");
  visit("account", o.account, "Slurm account");
  visit("qos", o.qos, "Slurm quality of service");
  visit("constraint", o.constraint, "Slurm node features, for example one processor type");
  visit("signal",
        o.signal,
        "time before the limit at which a shard stops starting cells [s]",
        Between{1.0, 65535.0});
  visit("stage", o.stage, "folder on the disk of a node to which inputs are copied; empty: none");
}

/// `base` with the settings of a map. Throws InputError `file:line:` for unknown settings and
/// invalid values.
ClusterSettings read_cluster(const YamlNode& node, const std::string& file, ClusterSettings base);

/// The settings of the user's file (if it exists), replaced by those of the config. Throws
/// InputError.
ClusterSettings cluster_settings(const std::filesystem::path& config,
                                 const std::filesystem::path& user_file);

/// $XDG_CONFIG_HOME/loopbench/cluster.yaml, or in ~/.config; empty if there is no home folder.
std::filesystem::path user_cluster_file();

/// `given` replaces settings of `base`. Throws OptionError for a value that is not accepted: names
/// of Slurm consist of letters, digits and `_.,+:&|()[]*-`.
ClusterSettings with_settings(const ClusterSettings& base, const Params& given);

/// Seconds of a time limit in Slurm's notation; 0 for an empty text. Throws OptionError.
std::int64_t limit_seconds(const std::string& time);

/// Bytes of a memory size; 0 for an empty text. Throws OptionError.
std::int64_t limit_bytes(const std::string& memory);

}  // namespace loopbench::harness
