/// JSON Schema of the lists of datasets, methods and metrics, see schema.cpp.
#pragma once

#include "harness/catalogue/catalogue.hpp"
#include "harness/commands/option_schema.hpp"

namespace loopbench::harness {

/// {datasets, methods, metrics}, whose entries are names of the catalogue, or maps with their
/// options. Adds what they refer to.
Json list_schemas(const Catalogue& catalogue, Json& definitions);

}  // namespace loopbench::harness
