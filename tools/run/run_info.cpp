// SPDX-License-Identifier: BSD-3-Clause
#include "run/run_info.hpp"

#include <ctime>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "core/version.hpp"
#include "messages/flags.hpp"
#include "results/host.hpp"

namespace planemap {

namespace {

using Json = nlohmann::ordered_json;

std::string utc_now() {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    char text[32];
    std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%SZ", &utc);
    return text;
}

}  // namespace

Json run_info(const messages::Flags& flags) {
    Json options = Json::object();
    for (const messages::FlagValue& flag : flags.values()) {
        options[flag.name] = std::visit(
            [](const auto& value) -> Json {
                if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::monostate>) {
                    return nullptr;
                } else {
                    return value;
                }
            },
            flag.value);
    }
    const auto known = [](const std::optional<std::string>& text) {
        return text ? Json(*text) : Json(nullptr);
    };
    return {{"version", version()},
            {"date", utc_now()},
            {"host", known(host_name())},
            {"cpu", known(cpu_model())},
            {"seed", options.value("seed", Json())},
            {"options", options}};
}

}  // namespace planemap
