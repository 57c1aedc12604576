// SPDX-License-Identifier: BSD-3-Clause
// Sessions: what a process sends from its start to its end, told apart by a number that every message of ours
// bears. A process that goes on with the state of an earlier one bears the number that follows the earlier
// one's, so that who hears it knows one sender that was started again from two senders at once.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace planemap::messages {

/// A new session, drawn at random; never 0.
std::int64_t random_session();

/// The session of a process that goes on with the state of one that had this session; never 0.
std::int64_t next_session(std::int64_t session);

/// Whether a process of session `later` goes on with the state of one of session `earlier`, at most
/// kMostRestarts processes after it.
bool succeeds(std::int64_t later, std::int64_t earlier);
inline constexpr int kMostRestarts = 64;

/// The session of a module that has its state in a folder: random the first time, from then on the next one.
/// It is on the disk, as `module`.session, when this returns. Throws std::runtime_error naming file and
/// reason.
std::int64_t session_with_state(const std::filesystem::path& folder, const std::string& module);

}  // namespace planemap::messages
