// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "benchmark/program.hpp"
#include "benchmark/sequences.hpp"
#include "results/output_file.hpp"
#include "results/table.hpp"

namespace planemap::benchmark {

using results::Json;
using results::Table;

/// What a benchmark says: tables for people on standard output (on stderr where --json has that), and all
/// rows as JSON in the file of --json.
class Report {
  public:
    /// Begins with what the figures are measured with, see build_info(). Throws std::runtime_error if the
    /// file cannot be written.
    Report(const Options& options, const std::string& peers);

    void print(const std::string& text);
    const std::vector<Json>& rows() const { return rows_; }
    void add(Json row) { rows_.push_back(std::move(row)); }
    /// Prints the row's line, too.
    void add(Json row, const Table& table);

    /// Calls `measure` for one sequence after the other; those whose data is missing are skipped, and it is
    /// said. What was measured is kept if a later one fails.
    void for_each(const std::vector<SequenceInfo>& sequences,
                  const std::function<void(const SequenceInfo&)>& measure);

    /// The rows are whole. Throws std::runtime_error if they cannot be written.
    void finish();

  private:
    OutputFile output_;
    std::vector<Json> rows_;
};

/// A benchmark once it knows what to measure: checks the options, begins a report, has `measure` fill it, and
/// ends it. Throws std::invalid_argument that names every wrong option, and as Report does.
void run_report(const Options& options, const std::string& peers,
                const std::function<void(Report&)>& measure);

}  // namespace planemap::benchmark
