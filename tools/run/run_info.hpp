// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace planemap {

namespace messages {
class Flags;
}

/// What a report says of the run itself: "version", "date" (when it is asked for, UTC, ISO 8601), "host" and
/// "cpu" (names; null where they are not known), "seed" (null unless --seed was given; the seeds in use are
/// among the options) and "options", all of them by the names of their flags, null where none was given.
nlohmann::ordered_json run_info(const messages::Flags& flags);

}  // namespace planemap
