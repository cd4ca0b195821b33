/// JSON Schema of the options of an entry, see schema.cpp.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>

#include "datasets/core/params.hpp"

namespace loopbench::harness {

using Json = nlohmann::ordered_json;

/// Type, default, bounds and help of one option. `accepts` is asked whether a real number can be
/// `none`.
Json option_schema(const OptionInfo& option, const std::function<bool(const Params&)>& accepts);

Json with_help(const std::string& help, const Json& schema);

/// A map with these properties and no others.
Json map_of(Json properties, Json required = {});

Json one_of(Json names);

/// A text, also one that looks like a number.
inline const Json kText{{"type", {"string", "number", "boolean"}}};

/// Adds options whose names contain dots as nested maps, too: `noise.gain` as {noise: {gain: 1}}.
void add_nested(Json& properties);

/// What `sweep` and `zip` contain for an option: a list, or a range {from, to, steps, log}.
/// Definition `values`.
Json values_schema();

/// A map of options to their values in a sweep. `options`: a map from names to their schemas.
Json grid_schema(const Json& options);

/// A schema that refers to a definition by its path.
Json reference(const std::string& path);
Json property_reference(const std::string& definition, const std::string& property);

}  // namespace loopbench::harness
