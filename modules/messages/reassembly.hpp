// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace planemap::messages {

/// UDP packets that this host's kernel gave up since it started, because a piece of them was lost on the way
/// or came too late (ReasmFails of /proc/net/snmp); nothing where the kernel does not tell. An LCM message
/// between hosts is such packets of up to 64 KiB, each in pieces of what the network carries.
std::optional<std::int64_t> failed_reassemblies(const std::filesystem::path& snmp = "/proc/net/snmp");

}  // namespace planemap::messages
