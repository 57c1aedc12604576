// SPDX-License-Identifier: BSD-3-Clause
#include "core/json_file.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/text_file.hpp"

namespace planemap {

namespace {

using nlohmann::json;

constexpr int kDeepest = 8;

/// Watches a document being parsed: JSON itself allows a key to stand twice, and any depth.
class Watch {
  public:
    bool operator()(int depth, json::parse_event_t event, const json& value) {
        using Event = json::parse_event_t;
        if (depth > kDeepest) {
            throw std::invalid_argument("nested deeper than " + std::to_string(kDeepest) + " levels");
        }
        if (event == Event::object_start) keys_.emplace_back();
        if (event == Event::object_end) keys_.pop_back();
        if (event == Event::key && !keys_.back().insert(value.get<std::string>()).second) {
            throw std::invalid_argument(
                "the key " + shown_text(value.dump(-1, ' ', false, json::error_handler_t::replace)) +
                " stands twice in one object");
        }
        return true;
    }

  private:
    std::vector<std::set<std::string>> keys_;
};

/// "line 3, column 5" of a byte.
std::string place_of(std::string_view text, std::size_t byte) {
    const std::string_view before = text.substr(0, byte);
    const auto lines = std::count(before.begin(), before.end(), '\n');
    const std::size_t start = before.rfind('\n') + 1;  // 0 if there is none
    return "line " + std::to_string(lines + 1) + ", column " + std::to_string(before.size() - start + 1);
}

/// The library's reason without its own names and place: what stands behind "column N: " or the "] ".
std::string reason_of(const json::exception& error) {
    const std::string text = error.what();
    std::size_t at = text.find("] ");
    at = at == std::string::npos ? 0 : at + 2;
    if (const std::size_t column = text.find(", column "); column != std::string::npos) {
        const std::size_t colon = text.find(": ", column);
        if (colon != std::string::npos) at = colon + 2;
    }
    constexpr std::size_t kLongest = 200;
    return shown_text(text.substr(at), kLongest);
}

json parse(const std::string& text) {
    try {
        return json::parse(text, Watch());
    } catch (const json::parse_error& error) {
        throw std::invalid_argument(place_of(text, error.byte == 0 ? 0 : error.byte - 1) + ": " +
                                    reason_of(error));
    } catch (const json::out_of_range& error) {  // a number that no double holds; its text ends the reason
        const std::string reason = error.what();
        const std::size_t quote = reason.find('\'');
        const std::size_t byte = quote == std::string::npos
                                     ? 0
                                     : text.find(reason.substr(quote + 1, reason.rfind('\'') - quote - 1));
        throw std::invalid_argument(place_of(text, std::min(byte, text.size())) + ": " + reason_of(error));
    }
}

}  // namespace

json read_json_object(const std::filesystem::path& file, std::size_t max_bytes) {
    const std::string text = read_text_file(file, max_bytes);
    try {
        json document = parse(text);
        if (!document.is_object()) throw std::invalid_argument("not a JSON object");
        return document;
    } catch (const std::invalid_argument& error) {
        throw std::invalid_argument(file.string() + ": " + error.what());
    }
}

}  // namespace planemap
