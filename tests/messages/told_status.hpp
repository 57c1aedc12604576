// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cctype>
#include <string>

#include "messages/bus.hpp"
#include "messages/channels.hpp"
#include "messages/decode.hpp"
#include "messages/module_status.hpp"

namespace planemap::test {

/// What a status tells on the bus, as the last message of its module.
inline module_status_t told(messages::ModuleStatus& status) {
    std::string channel = messages::channels::kStatusPrefix + status.module();
    for (char& c : channel) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    messages::Bus bus("memq://");
    module_status_t told;
    bus.subscribe(channel,
                  [&](const messages::RawMessage& m) { told = messages::decode<module_status_t>(m.bytes); });
    status.publish_if_due(bus, 1, true);
    bus.drain();
    return told;
}

}  // namespace planemap::test
