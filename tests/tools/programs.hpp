// SPDX-License-Identifier: BSD-3-Clause
// Programs as a user runs them: real files, real exit codes.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/files.hpp"

namespace planemap::test {

/// Runs programs of build/bin with a folder of its own.
class Programs : public testing::Test {
  protected:
    Programs() { std::filesystem::create_directories(folder_); }
    ~Programs() override { std::filesystem::remove_all(folder_); }

    struct Outcome {
        int exit_code;
        std::string out, err;
    };
    /// Runs a program of build/bin.
    Outcome run(const std::string& program, const std::string& arguments) {
        return run_shell(std::string(PLANEMAP_BIN) + "/" + program + " " + arguments);
    }
    /// Runs a line of bash, in which $bin is build/bin and $dir the test's folder.
    Outcome run_shell(const std::string& line) {
        const std::string out = folder_ / "stdout", err = folder_ / "stderr", script = folder_ / "script";
        write_file(script, "bin='" PLANEMAP_BIN "' dir='" + folder_.string() + "'\n" + line + "\n");
        const std::string command = "bash '" + script + "' >'" + out + "' 2>'" + err + "'";
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_file(out),
                read_file(err)};
    }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    nlohmann::json report(const std::string& output) {
        return nlohmann::json::parse(read_file(folder_ / output / "report.json"));
    }

    /// A run that must end with an error: exit code not 0, no crash, one line that names what is wrong.
    void expect_error(const std::string& program, const std::string& arguments, const std::string& named) {
        const Outcome result = run(program, arguments);
        EXPECT_NE(result.exit_code, 0) << arguments;
        EXPECT_LT(result.exit_code, 128) << arguments << "\n" << result.err;
        EXPECT_NE(result.err.find(named), std::string::npos) << arguments << "\n" << result.err;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << arguments << "\n"
                                                                             << result.err;
    }

    std::filesystem::path folder_ =
        std::filesystem::temp_directory_path() / ("planemap_programs_" + std::to_string(::getpid()));
};

}  // namespace planemap::test
