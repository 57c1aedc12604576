// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/child.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>

#include "core/processor_time.hpp"

namespace planemap::benchmark {

namespace {

void write_all(int file, const std::string& text) {
    for (std::size_t from = 0; from < text.size();) {
        const ssize_t written = ::write(file, text.data() + from, text.size() - from);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return;  // the parent is gone
        from += static_cast<std::size_t>(written);
    }
}

std::string read_all(int file) {
    std::string text;
    std::array<char, 1 << 16> buffer;
    while (true) {
        const ssize_t count = ::read(file, buffer.data(), buffer.size());
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return text;
        text.append(buffer.data(), static_cast<std::size_t>(count));
    }
}

/// What the child sends: its value, or the error that ended it.
std::string answer_of(const std::function<nlohmann::json()>& work) {
    try {
        return nlohmann::json{{"value", work()}}.dump();
    } catch (const std::exception& error) {
        return nlohmann::json{{"error", error.what()}}.dump(-1, ' ', false,
                                                            nlohmann::json::error_handler_t::replace);
    }
}

}  // namespace

ChildResult run_in_child(const std::function<nlohmann::json()>& work) {
    int ends[2];
    if (::pipe(ends) != 0) throw std::runtime_error(std::string("no pipe: ") + std::strerror(errno));
    std::fflush(nullptr);  // or the child would write it again
    const pid_t child = ::fork();
    if (child == 0) {
        ::close(ends[0]);
        write_all(ends[1], answer_of(work));
        std::fflush(nullptr);
        ::_exit(0);
    }
    const int fork_error = errno;
    ::close(ends[1]);
    const std::string answer = child > 0 ? read_all(ends[0]) : std::string();
    ::close(ends[0]);
    if (child < 0) throw std::runtime_error(std::string("cannot fork: ") + std::strerror(fork_error));
    int status = 0;
    rusage usage = {};
    while (::wait4(child, &status, 0, &usage) < 0 && errno == EINTR) {
    }
    if (WIFSIGNALED(status)) {
        throw std::runtime_error("its process was ended by signal " + std::to_string(WTERMSIG(status)) +
                                 " (" + ::strsignal(WTERMSIG(status)) + ")");
    }
    nlohmann::json parsed = nlohmann::json::parse(answer, nullptr, false);
    if (parsed.is_discarded()) throw std::runtime_error("its process ended without an answer");
    if (parsed.contains("error")) throw std::runtime_error(parsed["error"].get<std::string>());
    return {std::move(parsed["value"]), processor_seconds(usage),
            static_cast<double>(usage.ru_maxrss) / 1024};  // Linux counts in KiB
}

}  // namespace planemap::benchmark
