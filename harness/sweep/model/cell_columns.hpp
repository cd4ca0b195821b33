/// The columns of a cell: one list for the schema of stores, their writer and reader, and rows.csv.
#pragma once

#include "harness/sweep/model/record.hpp"

namespace loopbench::harness {

/// Name and meaning of a column.
struct CellColumn {
  const char* name;
  const char* meaning;            ///< comment in the schema
  const char* name_in_rows = "";  ///< of rows.csv; empty: not there
};

/// Visits what is measured in the process of a cell: `visit(CellColumn, member)`.
template <class Facts, class Visit>
void measured_fields(Facts& f, Visit&& visit) {
  visit(CellColumn{"waiting", "share of their wall time without a processor, 0..1"}, f.waiting);
  visit(CellColumn{"peak_memory", "largest resident size of the process [bytes]"}, f.peak_memory);
  visit(CellColumn{"added_memory", "increase of the resident size [bytes]"}, f.added_memory);
}

/// Visits the columns of a cell, in the order of the table.
template <class Row, class Visit>
void fields(Row& c, Visit&& visit) {
  visit(CellColumn{"sequence", "label of the dataset entry", "sequence"}, c.sequence);
  visit(CellColumn{"repeat", "instance of a seeded dataset, from 0", "repeat"}, c.repeat);
  visit(CellColumn{"method", "label of the method entry", "method"}, c.method);
  visit(CellColumn{"replay", "stages by their names in the catalogue; '': none"}, c.parts.replay);
  visit(CellColumn{"corrector", "or a method that corrects and smooths"}, c.parts.corrector);
  visit(CellColumn{"smoother", ""}, c.parts.smoother);
  visit(CellColumn{"program", "command of a stage that runs one; '': none"}, c.parts.program);
  visit(CellColumn{"dataset_options", "options that differ from the defaults"}, c.dataset_options);
  visit(CellColumn{"method_options", ""}, c.method_options);
  visit(CellColumn{"closures", "source of the loop closures", "closures"}, c.closures);
  visit(
      CellColumn{
          "oracle_closures", "1: measured in or selected by the reference", "oracle_closures"},
      c.oracle_closures);
  visit(CellColumn{"oracle", "1: the method uses or was trained on the reference", "oracle_method"},
        c.oracle);
  visit(CellColumn{"worker", "isolated | in process, with \", serial\", \", pinned\""}, c.worker);
  visit(CellColumn{"serial", "1: no other cell of the sweep ran at the same time"}, c.serial);
  visit(CellColumn{"stated_times", "1: the times are statements of a program"}, c.stated_times);
  visit(CellColumn{"runs", "timed runs of the method"}, c.runs);
  visit(CellColumn{"seconds_median", "wall time of one run"}, c.seconds);
  visit(CellColumn{"seconds_min", ""}, c.seconds_min);
  visit(CellColumn{"seconds_max", ""}, c.seconds_max);
  visit(CellColumn{"cpu_seconds_median", "CPU time of the process; NULL: unknown"}, c.cpu_seconds);
  visit(CellColumn{"cpu_seconds_min", ""}, c.cpu_seconds_min);
  visit(CellColumn{"cpu_variation", "standard deviation by mean of the runs; NULL: one run"},
        c.cpu_variation);
  measured_fields(c, visit);
  visit(CellColumn{"status",
                   "ok | declined | incomplete; failed | crashed | timeout | out_of_memory"},
        c.status);
  visit(CellColumn{"signal", "for example SIGSEGV; empty: not ended by a signal"}, c.signal);
  visit(CellColumn{"why", ""}, c.why);
}

}  // namespace loopbench::harness
