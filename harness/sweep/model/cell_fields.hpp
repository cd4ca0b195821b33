/// The fields of a cell: one list for the schema of stores, their writer and reader, and rows.csv.
/// Those that tables are arranged by, `table --columns`: record_columns.hpp.
#pragma once

#include "harness/sweep/model/record.hpp"

namespace loopbench::harness {

/// Name and meaning of a column of stores.
struct CellField {
  const char* name;
  const char* meaning;            ///< comment in the schema
  const char* name_in_rows = "";  ///< of rows.csv; empty: not there
};

/// Visits what is measured in the process of a cell: `visit(CellField, member)`.
template <class Facts, class Visit>
void measured_fields(Facts& f, Visit&& visit) {
  visit(CellField{"waiting", "share of their wall time without a processor, 0..1"}, f.waiting);
  visit(CellField{"peak_memory", "largest resident size of the process [bytes]"}, f.peak_memory);
  visit(CellField{"added_memory", "increase of the resident size [bytes]"}, f.added_memory);
}

/// Visits the columns of a cell, in the order of the table.
template <class Row, class Visit>
void fields(Row& c, Visit&& visit) {
  visit(CellField{"sequence", "label of the dataset entry", "sequence"}, c.sequence);
  visit(CellField{"repeat", "instance of a seeded dataset, from 0", "repeat"}, c.repeat);
  visit(CellField{"method", "label of the method entry", "method"}, c.method);
  visit(CellField{"replay", "stages by their names in the catalogue; '': none"}, c.parts.replay);
  visit(CellField{"corrector", "or a method that corrects and smooths"}, c.parts.corrector);
  visit(CellField{"smoother", ""}, c.parts.smoother);
  visit(CellField{"program", "command of a stage that runs one; '': none"}, c.parts.program);
  visit(CellField{"dataset_options", "options that differ from the defaults"}, c.dataset_options);
  visit(CellField{"method_options", ""}, c.method_options);
  visit(CellField{"closures", "source of the loop closures", "closures"}, c.closures);
  visit(
      CellField{
          "oracle_closures", "1: measured in or selected by the reference", "oracle_closures"},
      c.oracle_closures);
  visit(CellField{"oracle", "1: the method uses or was trained on the reference", "oracle_method"},
        c.oracle);
  visit(CellField{"worker", "isolated | in process, with \", serial\", \", pinned\""}, c.worker);
  visit(CellField{"serial", "1: no other cell of the sweep ran at the same time"}, c.serial);
  visit(CellField{"stated_times", "1: the times are statements of a program"}, c.stated_times);
  visit(CellField{"runs", "timed runs of the method"}, c.runs);
  visit(CellField{"seconds_median", "wall time of one run"}, c.seconds);
  visit(CellField{"seconds_min", ""}, c.seconds_min);
  visit(CellField{"seconds_max", ""}, c.seconds_max);
  visit(CellField{"cpu_seconds_median", "CPU time of the process; NULL: unknown"}, c.cpu_seconds);
  visit(CellField{"cpu_seconds_min", ""}, c.cpu_seconds_min);
  visit(CellField{"cpu_variation", "standard deviation by mean of the runs; NULL: one run"},
        c.cpu_variation);
  measured_fields(c, visit);
  visit(
      CellField{"status", "ok | declined | incomplete; failed | crashed | timeout | out_of_memory"},
      c.status);
  visit(CellField{"signal", "for example SIGSEGV; empty: not ended by a signal"}, c.signal);
  visit(CellField{"why", ""}, c.why);
}

}  // namespace loopbench::harness
