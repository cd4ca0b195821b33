#include "harness/sweep/process/own_process.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <new>

#include "datasets/core/error.hpp"
#include "datasets/core/pack.hpp"
#include "datasets/core/params.hpp"
#include "harness/sweep/process/child_process.hpp"
#include "harness/sweep/process/descendants.hpp"
#include "harness/sweep/process/result_area.hpp"
#include "harness/sweep/process/system_file.hpp"

namespace loopbench {

template <class Archive, Either<UnknownWord> T>
void walk(Archive& a, T& unknown) {
  a(unknown.word)(unknown.known)(unknown.listing);
}

}  // namespace loopbench

namespace loopbench::harness {
namespace {

using Clock = std::chrono::steady_clock;

enum class AnswerKind {
  returned,
  option_error,
  input_error,
  missing_part,
  out_of_memory,
  other_error
};

struct ChildAnswer {
  AnswerKind kind = AnswerKind::returned;
  std::string option;
  std::string text;  ///< of an OptionError, without its listing
  UnknownWord unknown = {};
};

template <class Archive, Either<ChildAnswer> T>
void walk(Archive& a, T& answer) {
  a(answer.kind)(answer.option)(answer.text)(answer.unknown);
}

ChildAnswer answer_of(const std::function<std::string()>& work) {
  try {
    return {AnswerKind::returned, "", work()};
  } catch (const OptionError& error) {
    std::string text = error.what();
    text.resize(text.size() - error.unknown().listing.size());
    return {AnswerKind::option_error, error.option(), text, error.unknown()};
  } catch (const InputError& error) {
    return {AnswerKind::input_error, "", error.what()};
  } catch (const MissingPart& error) {
    return {AnswerKind::missing_part, "", error.what()};
  } catch (const std::bad_alloc&) {
    return {AnswerKind::out_of_memory, "", ""};
  } catch (const std::exception& error) {
    return {AnswerKind::other_error, "", error.what()};
  } catch (...) {
    return {AnswerKind::other_error, "", "threw something that is not a std::exception"};
  }
}

/// False after the deadline.
bool wait_for(const ChildProcess& child, double seconds) {
  const auto begin = Clock::now();
  for (;;) {
    const std::chrono::duration<double> passed = Clock::now() - begin;
    const double left = seconds > 0.0 ? seconds - passed.count() : 1.0;
    if (left <= 0.0) return false;
    if (child.has_ended(static_cast<int>(1e3 * left) + 1)) return true;
  }
}

}  // namespace

std::string in_own_process(const std::function<std::string()>& work, const ProcessLimits& limits) {
  const Subreaper reaper;  // of programs, which lead process groups of their own
  ResultArea area;
  std::fflush(nullptr);  // otherwise the process would print buffered output again
  ChildProcess child(ProcessGroup::own, [&] {
    dup2(STDERR_FILENO, STDOUT_FILENO);
    if (limits.memory > 0) limit_data_memory(limits.memory);
    Packer pack;
    pack(answer_of(work));
    return area.write(pack.bytes()) ? 0 : 1;
  });
  const bool is_in_time = wait_for(child, limits.seconds);
  const pid_t id = child.id();
  const int status = child.end();
  if (!is_in_time) throw ProcessFailure(fmt::format("took longer than {} s", limits.seconds));
  const auto bytes = area.read(id);
  if (!bytes) throw ProcessFailure(end_text(status));
  ChildAnswer answer;
  Unpacker unpack(*bytes);
  unpack(answer);
  switch (answer.kind) {
    case AnswerKind::returned:
      return answer.text;
    case AnswerKind::option_error:
      throw OptionError(answer.option, answer.text, answer.unknown);
    case AnswerKind::input_error:
      throw InputError(answer.text);
    case AnswerKind::missing_part:
      throw MissingPart(answer.text);
    case AnswerKind::out_of_memory:
      throw ProcessFailure(
          limits.memory > 0
              ? fmt::format("needs more memory than the limit of {} bytes", limits.memory)
              : "needs more memory than there is");
    case AnswerKind::other_error:
      break;
  }
  throw std::runtime_error(answer.text);
}

}  // namespace loopbench::harness
