/// Converts exceptions of methods and metrics to a status with its reason.
#pragma once

#include <exception>
#include <new>

#include "datasets/core/error.hpp"
#include "harness/model/status.hpp"
#include "harness/run/check_output.hpp"

namespace loopbench::harness {

/// what() of a plugin's exception can be null or empty.
inline const char* message_of(const std::exception& error) {
  const char* out = error.what();
  return out != nullptr && *out != '\0' ? out : "threw an exception without a message";
}

/// Runs `work` and sets status and why of `result` for any exception: declined for an exception
/// Declined, otherwise failed.
template <class Result, class Work>
void catch_errors(Result& result, Work work) {
  try {
    work();
  } catch (const Declined& reason) {
    result.status = Status::declined;
    result.why = stored_reason(message_of(reason));
  } catch (const std::bad_alloc&) {
    result.status = Status::out_of_memory;
    result.why = "memory allocation failed";
  } catch (const std::exception& error) {
    result.status = Status::failed;
    result.why = stored_reason(message_of(error));
  } catch (...) {
    result.status = Status::failed;
    result.why = "threw an exception that is not a std::exception";
  }
}

}  // namespace loopbench::harness
