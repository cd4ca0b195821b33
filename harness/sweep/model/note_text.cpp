#include "harness/sweep/model/note_text.hpp"

#include <fmt/format.h>

#include "datasets/core/fields.hpp"
#include "datasets/formats/formats.hpp"

namespace loopbench::harness {
namespace {

std::string remedy_text(const Note& note) {
  const auto& [option, value] = note.remedy;
  if (option == kConfigProtocol) return fmt::format("{}: {}", option, value);
  return option + (value.empty() ? "" : " ") + value;
}

/// "; use --max-diff 0.1", or nothing.
std::string with_remedy(const std::string& sentence, const Note& note, const char* before) {
  return note.remedy.option.empty() ? sentence : sentence + before + remedy_text(note);
}

std::string of_words(const Note& note) { return note.detail; }

std::string of_finding(const Note& note) {
  return fmt::format("doctor: {}: {}; {} (confidence {:.2f})",
                     to_text(note.kind),
                     note.detail,
                     remedy_text(note),
                     note.number("confidence"));
}

std::string of_omitted(const Note& note) {
  return fmt::format("{:.0f} more notes", note.number("notes"));
}

std::string of_oracle(const Note& note) { return "oracle: " + note.detail; }

std::string of_alignment(const Note& note) {
  return "aligned by " + note.detail + " under every protocol";
}

std::string of_low_coverage(const Note& note) {
  return fmt::format("low coverage: {:.0f} of {:.0f} poses over {:.1f} % of the reference's time",
                     note.number("pairs"),
                     note.number("possible"),
                     note.number("span"));
}

std::string of_unpaired(const Note& note) {
  return fmt::format("{:.0f} of {:.0f} poses are paired{}",
                     note.number("pairs"),
                     note.number("possible"),
                     note.detail);
}

std::string of_few_pairs(const Note& note) {
  return fmt::format(
      "few pairs: {:.0f} pairs have {:.0f} coordinates, and alignment {} fits {:.0f} parameters to "
      "them, so the errors are about {:.0f} % too small",
      note.number("pairs"),
      note.number("coordinates"),
      note.detail,
      note.number("parameters"),
      note.number("bias"));
}

std::string of_association(const Note& note) {
  return with_remedy(
      fmt::format("association: the stamps of paired poses differ by up to {:.3g} s; at the "
                  "reference's speed this is an error of {:.3g} m (rmse), with an ATE of {:.3g} m",
                  note.number("largest difference"),
                  note.number("error"),
                  note.number("ate")),
      note,
      "; use ");
}

std::string of_tracking_gaps(const Note& note) {
  return fmt::format(
      "tracking gaps: {:.3g} s between keyframes are bridged without a measurement, and {} "
      "(max_estimate_gap)",
      note.number("bridged"),
      note.number("evaluated") != 0.0 ? "evaluated nevertheless" : "not evaluated");
}

std::string of_datum(const Note& note) {
  return fmt::format(
      "datum: both files {} in the same frame: ATE {:.4g} m without alignment ({}), {:.4g} m with "
      "{}",
      note.number("stated") != 0.0 ? "are" : "seem to be",
      note.number("unaligned"),
      remedy_text(note),
      note.number("aligned"),
      note.detail);
}

std::string of_reference_error(const Note& note) {
  const double error = note.number("ate"), own = note.number("error");
  const std::string sentence =
      fmt::format("reference: {:g} m per axis amounts to a position error of {:.3g} m (rmse)",
                  note.number("sigma"),
                  own);
  if (error <= own) {
    return sentence +
           fmt::format(": the ATE of {:.3g} m is below it and shows nothing else", error);
  }
  return sentence + fmt::format("; without it, an ATE of {:.4g} m would be about {:.4g} m",
                                error,
                                note.number("without"));
}

std::string of_paired_rows(const Note& note) {
  const std::string sentence = fmt::format(
      "paired by row: the files have {:.0f} rows each and no stamps", note.number("rows"));
  if (note.number("pairs") == note.number("rows")) return sentence;
  return sentence + fmt::format(", {:.0f} are paired", note.number("pairs"));
}

std::string of_common_times(const Note& note) {
  return fmt::format(
      "evaluated over the times that all estimates of the sequence cover: {:.0f} of {:.0f} poses "
      "are left out ({} evaluates all)",
      note.number("left out"),
      note.number("poses"),
      remedy_text(note));
}

std::string of_damaged_file(const Note& note) { return "damaged file: " + note.detail; }

std::string of_nondeterministic(const Note& note) {
  return fmt::format(
      "nondeterministic: {:.0f} runs on the same input gave {:.0f} different trajectories",
      note.number("runs"),
      note.number("trajectories"));
}

std::string of_reading(const Note& note) {
  const auto first = static_cast<int>(NoteKind::dropped_rows);
  const auto kind = static_cast<RowChange::Kind>(static_cast<int>(note.kind) - first);
  return to_text(RowChange{kind, note.number("value")});
}

using TextOf = std::string (*)(const Note&);

TextOf text_of(NoteKind kind) {
  switch (kind) {
    case NoteKind::omitted:
      return of_omitted;
    case NoteKind::oracle:
      return of_oracle;
    case NoteKind::alignment:
      return of_alignment;
    case NoteKind::low_coverage:
      return of_low_coverage;
    case NoteKind::unpaired:
      return of_unpaired;
    case NoteKind::few_pairs:
      return of_few_pairs;
    case NoteKind::association:
      return of_association;
    case NoteKind::tracking_gaps:
      return of_tracking_gaps;
    case NoteKind::datum:
      return of_datum;
    case NoteKind::reference_error:
      return of_reference_error;
    case NoteKind::paired_rows:
      return of_paired_rows;
    case NoteKind::common_times:
      return of_common_times;
    case NoteKind::damaged_file:
      return of_damaged_file;
    case NoteKind::nondeterministic:
      return of_nondeterministic;
    default:
      if (is_of_reading(kind)) return of_reading;
      return is_of_doctor(kind) ? of_finding : of_words;
  }
}

}  // namespace

std::string text(const Note& note) {
  const std::string sentence = text_of(note.kind)(note);
  return note.subject.empty() ? sentence : note.subject + ": " + sentence;
}

std::vector<std::string> texts(const std::vector<Note>& notes) {
  std::vector<std::string> out;
  for (const Note& note : notes) out.push_back(text(note));
  return out;
}

}  // namespace loopbench::harness
