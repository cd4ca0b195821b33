/// JSON Schema (draft 7) of configs, generated from the catalogue: what `list --json` prints, and
/// the keys that `run` accepts.
#pragma once

#include <nlohmann/json.hpp>

#include "harness/catalogue/catalogue.hpp"

namespace loopbench::harness {

/// Names of entries are checked unless a config lists plugins, whose names it cannot contain.
nlohmann::ordered_json config_schema(const Catalogue& catalogue);

}  // namespace loopbench::harness
