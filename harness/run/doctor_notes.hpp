/// Findings of `doctor` as notes of an evaluation or a sweep.
#pragma once

#include <string>
#include <vector>

#include "harness/catalogue/catalogue.hpp"
#include "harness/model/result.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// Notes that start with this are findings of the doctor.
inline constexpr const char* kDoctorPrefix = "doctor: ";

/// Two trajectories as they were read.
struct ReadPair {
  const Trajectory& reference;
  const Trajectory& estimate;
  std::string reference_name;
  std::string estimate_name;
  bool has_stamps = true;  ///< false if the stamps of either are generated
};

/// "doctor: ..." for each finding with a confidence of at least 0.5 that the protocols leave: the
/// estimate is shifted by the offset of the first one, and its scale is checked only if some
/// protocol does not align it. Empty without protocols.
std::vector<std::string> doctor_notes(const ReadPair& pair,
                                      const std::vector<metrics::NamedProtocol>& protocols);

/// The same for the keyframes of measured data, with options of configs, and for its closures and
/// information. Empty for simulated data.
std::vector<std::string> doctor_notes(const Sequence& sequence, const Sweep& sweep);

/// "doctor: ..." for each finding about closures and information with a confidence of at least 0.5.
std::vector<std::string> closure_notes(const Problem& problem);

/// The finding that the closures moved nothing; empty if they did, if the method rejected all of
/// them, or if `uses_closures` is false.
std::string movement_note(const Problem& problem,
                          const Trajectory& corrected,
                          const methods::Report& report,
                          bool uses_closures);

/// Whether a stage of the method corrects keyframes by closures.
bool uses_closures(const MethodChoice& choice, const Catalogue& catalogue);

/// Collects the notes "doctor: ..." of cells: one line for each method, with its first note and the
/// number of further cells.
class CellNotes {
 public:
  void add(const std::string& method, const CellResult& result);
  std::vector<std::string> lines() const;

 private:
  struct Noted {
    std::string method, note;
    std::size_t others = 0;  ///< cells
  };
  std::vector<Noted> all_;
};

}  // namespace loopbench::harness
