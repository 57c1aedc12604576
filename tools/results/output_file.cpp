// SPDX-License-Identifier: BSD-3-Clause
#include "results/output_file.hpp"

#include <stdexcept>

#include "core/files.hpp"
#include "core/standard_output.hpp"

namespace planemap {

OutputFile::OutputFile(const std::filesystem::path& file) : file_(file), to_stdout_(file == "-") {
    std::error_code ignored;
    const std::filesystem::file_status status = std::filesystem::status(file_, ignored);
    const bool is_device = std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
                           !std::filesystem::is_directory(status);
    if (file_.empty() || to_stdout_ || is_device) return;
    const std::string name = file_.filename().string();
    if (name.empty()) throw std::runtime_error(file_.string() + ": is a folder, where a file is to go");
    is_new_ = !std::filesystem::exists(status);
    const std::filesystem::path folder = file_.parent_path().empty() ? "." : file_.parent_path();
    results_ = std::make_unique<ResultFolder>(folder, std::vector<std::string>{name}, "." + name + ".part");
    for (const std::string& note : results_->take_notes()) std::fprintf(stderr, "%s\n", note.c_str());
}

OutputFile::~OutputFile() {
    try {
        if (!results_ || !results_->holds_made()) return;
        std::fprintf(stderr, "%s: not whole; what there is so far is in %s\n", file_.c_str(),
                     results_->set_aside().c_str());
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
    }
}

void OutputFile::keep(const std::string& so_far) {
    if (!results_) return;
    results_->make({file_.filename().string(), [&](const auto& file) { write_file(file, so_far); }});
    if (is_new_) results_->replace();
}

void OutputFile::finish(const std::string& whole) {
    if (to_stdout_) return print(whole);
    if (results_) {
        results_->make({file_.filename().string(), [&](const auto& file) { write_file(file, whole); }});
        results_->replace();
    } else if (!file_.empty()) {
        write_file(file_, whole);
    }
    finish_printing();
}

}  // namespace planemap
