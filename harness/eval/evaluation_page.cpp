#include "harness/eval/evaluation_page.hpp"

#include <utility>

#include "datasets/bags/bag_trajectory.hpp"
#include "harness/base/write_file.hpp"
#include "harness/catalogue/scratch.hpp"
#include "harness/report/report.hpp"
#include "harness/run/build.hpp"
#include "harness/store/store.hpp"

namespace loopbench::harness {

void write_evaluation_page(RecordedSweep files,
                           const std::vector<EvaluatedFile>& evaluations,
                           const Source& source) {
  const EvalArguments& a = files.arguments;
  Sweep& sweep = files.sweep;
  sweep.name = "Evaluation against " +
               std::filesystem::path(file_of(files.runs.front().reference)).filename().string();
  if (a.figures.labels.size() == sweep.methods.size()) {
    for (std::size_t i = 0; i < sweep.methods.size(); ++i) {
      sweep.methods[i].label = a.figures.labels[i];
    }
    sweep.baseline = sweep.methods.front().label;
  }
  const ExchangeFolder folder;
  const std::filesystem::path file = folder.path() / "results.sqlite";
  CellKeys keys(sweep, files.catalogue, DataRoot{}, build_id(source.code));
  Store store(file, keys, provenance(source, sweep, files.catalogue));
  store.resume(files.cells, files.cells, Retry::failed);
  for (const EvaluatedFile& each : evaluations) store.write(each.result);
  store.close();
  ReportContent content = read_report_content(file, kReportBytes);
  content.plane = a.figures.plane;
  write_file(a.report, report_html(std::move(content), kReportBytes));
}

}  // namespace loopbench::harness
