/// Methods and metrics in one word of the command line: NAME:option=value,option=value.
#pragma once

#include <string>
#include <vector>

#include "harness/catalogue/catalogue.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// The choice of a method as in a config, or of a corrector + smoother. Throws InputError, also for
/// a text with several methods.
MethodChoice parse_method(const std::string& text, const Catalogue& catalogue);

/// The choice of a metric as in a config; its options must be compatible with each of the
/// protocols. Throws InputError, with a suggestion for an unknown name.
MetricChoice parse_metric(const std::string& text,
                          const Catalogue& catalogue,
                          const std::vector<metrics::NamedProtocol>& protocols);

/// The values of `--set NAME=VALUE`; those of text options as written. Names and ranges are checked
/// by whoever applies them. Throws InputError with what is `expected`.
Params parse_settings(const std::vector<std::string>& settings,
                      const std::vector<OptionInfo>& options,
                      const std::string& expected);

}  // namespace loopbench::harness
